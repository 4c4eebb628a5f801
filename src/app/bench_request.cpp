// app/bench_request.cpp - turns the option texts of `obscura bench` into a request.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_request.h"

#include "app/asset_choice.h"
#include "app/bench_options.h"
#include "app/option_readers.h"
#include "app/render_options.h"
#include "base/parallel.h"
#include "render/integrators.h"

#include <algorithm>
#include <functional>
#include <string_view>

namespace obscura::app {

namespace {

std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == ',') {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

Result<void> check_sense(const BenchArguments& arguments, const BenchRequest& request) {
    const RenderArguments& render = arguments.render;
    if (render.camera_model && *render.camera_model != "pinhole") {
        return conflict("--camera-model", "the bench measures through a pinhole; leave it out");
    }
    if (render.env_rotation && render.env_rotation->starts_with("camera")) {
        return conflict("--env-rotation",
                        "the bench prepares a scene for all its views; expected a number of "
                        "degrees");
    }
    if (request.plot && request.threads.size() < 2 && request.isas.size() < 2) {
        return conflict("--plot",
                        "there is nothing to draw; give several --threads (1,2,4) or several "
                        "--isa (all)");
    }
    return {};
}

/// What --standard measures is fixed.
Result<void> check_standard(const Command& command, const BenchRequest& request) {
    constexpr std::array<std::string_view, 8> allowed = {"--standard",
                                                         "--threads",
                                                         "--isa",
                                                         "--json",
                                                         "--compare",
                                                         "--quiet",
                                                         "--verbose",
                                                         "--config"};
    for (const BoundOption& option : command.options) {
        const std::string name = long_name(option.info);
        if (!is_given(option) || std::find(allowed.begin(), allowed.end(), name) != allowed.end())
            continue;
        return conflict(name, "what --standard measures is fixed; leave it out");
    }
    if (request.threads.size() == 1 && request.isas.size() == 1) return {};
    return conflict(request.isas.size() == 1 ? "--threads" : "--isa",
                    "a score of --standard is for one of them; give one");
}

/// One scene's request.
Result<RenderRequest> request_for(const BenchArguments& arguments, const std::string& scene) {
    RenderArguments render = arguments.render;
    render.scene_file = scene;
    render.writes_images = false;
    for (const auto* output : {&arguments.json, &arguments.plot}) {
        if (*output) render.outputs.push_back(**output);
    }
    if (!render.spp) render.spp = bench_spp;
    Result<RenderRequest> request = make_render_request(render);
    if (!request) return request;
    if (request->options.adaptive) {
        return conflict("--spp",
                        "speed is measured with equally many samples a pixel; give a number");
    }
    if (!render.size) {
        const bool aov = is_aov(request->options.integrator);
        const auto& [width, height] = aov ? bench_aov_size : bench_size;
        request->options.width = width;
        request->options.height = height;
    }
    request->options.samples_per_pixel = samples_taken(request->options);
    if (request->options.integrator == Integrator::heat) {
        return fail(ExitCode::usage,
                    "E-USAGE-CHOICE",
                    "--integrator",
                    "'heat' asks no rays that could be measured; choose another");
    }
    return request;
}

}  // namespace

Result<std::vector<int>> parse_thread_counts(const std::string& text, const std::string& option) {
    std::vector<int> counts;
    for (const std::string& part : split_at_commas(text)) {
        const Result<int64_t> count = parse_integer(part, option, 0, 1024);
        if (!count) return fail(count.error());
        counts.push_back(ThreadLimit(static_cast<int>(*count)).threads());
    }
    std::sort(counts.begin(), counts.end(), std::greater<>());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
}

Result<std::vector<Isa>> parse_isas(const std::string& text, const std::string& option) {
    std::vector<Isa> isas;
    const auto add = [&](Isa isa) {
        if (std::find(isas.begin(), isas.end(), isa) == isas.end()) isas.push_back(isa);
    };
    for (const std::string& part : split_at_commas(text)) {
        if (part == "all") {
            for (const Isa isa : {Isa::avx512, Isa::avx2, Isa::baseline}) {
                if (has_isa(isa)) add(isa);
            }
            continue;
        }
        const Result<Isa> isa = choose_option(part, option, instruction_sets);
        if (!isa) return fail(isa.error());
        add(*isa);
    }
    return isas;
}

Result<BenchRequest> make_bench_request(const BenchArguments& arguments) {
    BenchRequest request;
    BenchArguments texts = arguments;
    if (!texts.threads) texts.threads = "0";
    if (!texts.isa) texts.isa = "auto";
    const auto table = bench_option_groups();
    if (auto read = read_options(table, texts, request); !read) return fail(read.error());
    const Command command = bench_command(texts);
    if (auto fit = check_combinations(command.options); !fit) return fail(fit.error());
    if (request.standard) {
        if (auto sound = check_standard(command, request); !sound) return fail(sound.error());
        request.verbosity = verbosity_of(arguments.render);
        return request;
    }
    if (auto sound = check_sense(arguments, request); !sound) return fail(sound.error());
    Result<std::vector<RenderRequest>> scenes =
        requests_for(arguments.scenes, arguments.assets, [&](const std::string& scene) {
            return request_for(arguments, scene);
        });
    if (!scenes) return fail(scenes.error());
    request.scenes = std::move(*scenes);
    request.verbosity = request.scenes.front().verbosity;
    return request;
}

}  // namespace obscura::app
