// app/denoise_request.cpp - turns the option texts of `obscura denoise` into a request.
// SPDX-License-Identifier: Apache-2.0
#include "app/denoise_request.h"

#include "app/denoise_options.h"
#include "app/distinct_files.h"
#include "app/frames.h"
#include "session/image_names.h"

#include <algorithm>
#include <set>

namespace obscura::app {

namespace {

/// Sorts the outputs by what writes them.
Result<void> choose_outputs(const DenoiseArguments& arguments, DenoiseRequest& request) {
    if (arguments.outputs.empty())
        return conflict("--output", "it is missing; give -o OUT.exr, which may be IN.exr itself");
    std::vector<std::filesystem::path> all;
    for (const std::string& name : arguments.outputs) {
        const std::filesystem::path file = name;
        const bool is_known = std::any_of(
            all.begin(), all.end(), [&](const auto& other) { return same_file(file, other); });
        if (is_known) {
            return fail(ExitCode::usage,
                        "E-USAGE-SAMEFILE",
                        name,
                        "two outputs are the same file; give different names");
        }
        all.push_back(file);
        const Result<OutputTarget> target = check_output(file);
        if (!target) return fail(target.error());
        const bool is_exr = target->format == OutputFormat::exr;
        (is_exr ? request.exrs : request.render.outputs).push_back(file);
    }
    return {};
}

/// Fields of names that only a scene has a text for.
Result<void> check_fields(const std::filesystem::path& pattern) {
    for (const char* field : {"asset", "look", "variant", "view"}) {
        if (!has_field(pattern, field)) continue;
        return conflict(pattern.string(),
                        "{" + std::string(field) +
                            "} stands for nothing here; accepted are one run " +
                            "of # and {frame:04}, for the frame's number");
    }
    return {};
}

/// A sequence's names must tell its frames apart, and no frame may be replaced while its neighbours
/// need it.
Result<void> check_sequence(const DenoiseRequest& request) {
    if (!request.render.frames) return {};
    std::vector<std::filesystem::path> outputs = request.render.outputs;
    outputs.insert(outputs.end(), request.exrs.begin(), request.exrs.end());
    std::vector<std::filesystem::path> patterns = outputs;
    patterns.push_back(request.file);
    if (auto named = check_frame_patterns(patterns); !named) return named;
    for (const std::filesystem::path& pattern : patterns) {
        if (auto known = check_fields(pattern); !known) return known;
    }
    const auto file_of = [](const std::filesystem::path& pattern, int frame) {
        return std::filesystem::absolute(numbered_file(pattern, frame)).lexically_normal();
    };
    std::set<std::filesystem::path> taken;
    for (const int number : request.render.frames->numbers) {
        for (const int read : {number - 1, number, number + 1})
            taken.insert(file_of(request.file, read));
    }
    for (const int number : request.render.frames->numbers) {
        for (const std::filesystem::path& output : outputs) {
            if (taken.insert(file_of(output, number)).second) continue;
            return fail(
                ExitCode::usage,
                "E-USAGE-SAMEFILE",
                numbered_file(output, number).string(),
                "with --frames this file is written twice, or read: frames beside a frame are "
                "filtered with it; give outputs other names");
        }
    }
    return {};
}

}  // namespace

Result<DenoiseRequest> make_denoise_request(const DenoiseArguments& arguments) {
    DenoiseArguments texts = arguments;
    const Command command = denoise_command(texts);
    if (auto fit = check_combinations(command.options); !fit) return fail(fit.error());
    RenderArguments render = arguments.render;
    render.scene_file = arguments.file;
    render.writes_images = false;
    Result<RenderRequest> display = make_render_request(render);
    if (!display) return fail(display.error());
    if (display->exposure_group) {
        return fail(ExitCode::usage,
                    "E-USAGE-CHOICE",
                    "--exposure",
                    "expected a number: there is no scene whose light could be metered");
    }
    DenoiseRequest request;
    request.file = arguments.file;
    request.keep_noisy = arguments.keep_noisy;
    request.render = std::move(*display);
    if (auto chosen = choose_outputs(arguments, request); !chosen) return fail(chosen.error());
    if (auto fit = check_sequence(request); !fit) return fail(fit.error());
    return request;
}

}  // namespace obscura::app
