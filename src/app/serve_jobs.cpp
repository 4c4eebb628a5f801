// app/serve_jobs.cpp - how `obscura serve` runs jobs.
// SPDX-License-Identifier: Apache-2.0
#include "app/serve_jobs.h"

#include "app/json_options.h"
#include "app/render_options.h"

#include <array>
#include <filesystem>
#include <system_error>

namespace obscura::app {

namespace {

constexpr std::array passed_options = {
    "--threads", "--priority", "--max-memory", "--texture-memory", "--texture-cache", "--isa"};

/// Jobs run in folders of their own.
std::string from_everywhere(const std::string& file) {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(file, error);
    return error ? file : whole.string();
}

}  // namespace

void complete_jobs_options(const RenderArguments& common, serve::JobsOptions& jobs) {
    RenderArguments texts = common;
    const std::vector<BoundOption> table = bind_all(std::span(render_option_groups()), texts);
    bool has_priority = false;
    for (const std::string name : passed_options) {
        const BoundOption* const option = find_option(table, name);
        auto* const* text = option != nullptr ? std::get_if<OptionText*>(&option->target) : nullptr;
        if (text == nullptr || !**text) continue;
        const std::string value = ***text;
        jobs.words.push_back(name);
        jobs.words.push_back(name == "--texture-cache" ? from_everywhere(value) : value);
        has_priority = has_priority || name == "--priority";
    }
    // Who looks at a preview goes first.
    if (!has_priority) jobs.words.insert(jobs.words.end(), {"--priority", "low"});
    if (texts.ocio) jobs.options["ocio"] = from_everywhere(*texts.ocio);
}

}  // namespace obscura::app
