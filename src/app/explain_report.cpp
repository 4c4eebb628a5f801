// app/explain_report.cpp - what `obscura info --explain` says: the fate of every part's wishes.
// SPDX-License-Identifier: Apache-2.0
#include "app/explain_report.h"

#include "base/json/json.h"
#include "base/log.h"
#include "gltf/report.h"

#include <array>
#include <fmt/format.h>

namespace obscura {

namespace {

constexpr std::array verdicts = {Verdict::honoured, Verdict::approximated, Verdict::ignored};

size_t count_of(const AssetInfo& info, Verdict verdict) {
    size_t out = 0;
    for (const ReportRow& row : info.report)
        out += row.verdict == verdict ? 1U : 0U;
    return out;
}

}  // namespace

std::string explain_table(const AssetInfo& info) {
    std::string text;
    const std::string* place = nullptr;
    for (const ReportRow& row : info.report) {
        if (place == nullptr || *place != row.place) text += escape_control(row.place) + "\n";
        place = &row.place;
        text += fmt::format("  {:<12} {}{}{}\n",
                            verdict_name(row.verdict),
                            escape_control(row.feature),
                            row.note.empty() ? "" : ": ",
                            row.note);
    }
    std::string counts;
    for (const Verdict verdict : verdicts) {
        counts += fmt::format(
            "{}{} {}", counts.empty() ? "" : ", ", count_of(info, verdict), verdict_name(verdict));
    }
    return text + counts + "\n";
}

std::string explain_json(const AssetInfo& info) {
    Json json;
    json["version"] = OBSCURA_VERSION;
    json["file"] = info.file_name;
    for (const Verdict verdict : verdicts)
        json[verdict_name(verdict)] = count_of(info, verdict);
    Json& report = json["report"] = Json::array();
    for (const ReportRow& row : info.report) {
        report.push_back({{"place", row.place},
                          {"feature", row.feature},
                          {"verdict", verdict_name(row.verdict)},
                          {"note", row.note}});
    }
    return json_document(json);
}

}  // namespace obscura
