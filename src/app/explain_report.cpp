// app/explain_report.cpp - `obscura info --explain`: the support of every feature in a file.
// SPDX-License-Identifier: Apache-2.0
#include "app/explain_report.h"

#include "base/json/json.h"
#include "base/log.h"
#include "gltf/report.h"

#include <array>
#include <fmt/format.h>

namespace obscura::app {

namespace {

constexpr std::array verdicts = {Verdict::honoured, Verdict::approximated, Verdict::ignored};

size_t count_of(const AssetInfo& info, Verdict verdict) {
    size_t out = 0;
    for (const ReportEntry& entry : info.report)
        out += entry.verdict == verdict ? 1U : 0U;
    return out;
}

}  // namespace

std::string explain_table(const AssetInfo& info) {
    std::string text;
    const std::string* place = nullptr;
    for (const ReportEntry& entry : info.report) {
        if (place == nullptr || *place != entry.place) text += escape_control(entry.place) + "\n";
        place = &entry.place;
        text += fmt::format("  {:<12} {}{}{}\n",
                            gltf::verdict_name(entry.verdict),
                            escape_control(entry.feature),
                            entry.note.empty() ? "" : ": ",
                            entry.note);
    }
    std::string counts;
    for (const Verdict verdict : verdicts) {
        counts += fmt::format("{}{} {}",
                              counts.empty() ? "" : ", ",
                              count_of(info, verdict),
                              gltf::verdict_name(verdict));
    }
    return text + counts + "\n";
}

std::string explain_json(const AssetInfo& info) {
    Json json;
    json["version"] = OBSCURA_VERSION;
    json["file"] = info.file_name;
    for (const Verdict verdict : verdicts)
        json[gltf::verdict_name(verdict)] = count_of(info, verdict);
    Json& report = json["report"] = Json::array();
    for (const ReportEntry& entry : info.report) {
        report.push_back({{"place", entry.place},
                          {"feature", entry.feature},
                          {"verdict", gltf::verdict_name(entry.verdict)},
                          {"note", entry.note}});
    }
    return json_document(json);
}

}  // namespace obscura::app
