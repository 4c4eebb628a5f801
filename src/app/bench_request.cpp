// app/bench_request.cpp - from the texts of `obscura bench` to a checked request.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_request.h"

#include "app/asset_choice.h"
#include "app/numbers.h"
#include "base/parallel.h"
#include "render/integrators.h"

#include <algorithm>
#include <functional>

namespace obscura {

namespace {

tl::unexpected<Error> conflict(const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, "E-USAGE-CONFLICT", where, message);
}

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

/// Each thread count once, 0 as the number of cores; the greatest first.
Result<std::vector<int>> parse_threads(const std::string& text) {
    std::vector<int> counts;
    for (const std::string& part : split_at_commas(text)) {
        const Result<int64_t> count = parse_integer(part, "--threads", 0, 1024);
        if (!count) return fail(count.error());
        counts.push_back(ThreadLimit(static_cast<int>(*count)).threads());
    }
    std::sort(counts.begin(), counts.end(), std::greater<>());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
}

/// Each instruction set once, in the order given; "all" is what this CPU has, widest first.
Result<std::vector<Isa>> parse_isas(const std::string& text) {
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
        const Result<Isa> isa = parse_isa(part);
        if (!isa) return fail(isa.error());
        add(*isa);
    }
    return isas;
}

Result<ViewChoice> parse_view(const std::string& text) {
    if (text == "whole") return ViewChoice::whole;
    if (text == "close") return ViewChoice::close;
    if (text == "both") return ViewChoice::both;
    return fail(ExitCode::usage,
                "E-USAGE-CHOICE",
                "--view",
                in_quotes(text) + " is not accepted; expected one of: whole, close, both");
}

/// The bench's own numbers and lists.
Result<void> parse_own(const BenchArguments& arguments, BenchRequest& request) {
    const Result<std::vector<int>> threads = parse_threads(arguments.threads.value_or("0"));
    if (!threads) return fail(threads.error());
    request.threads = *threads;
    const Result<std::vector<Isa>> isas = parse_isas(arguments.isa.value_or("auto"));
    if (!isas) return fail(isas.error());
    request.isas = *isas;
    const Result<int64_t> repeat =
        parse_integer(arguments.repeat.value_or("5"), "--repeat", 1, 1000);
    if (!repeat) return fail(repeat.error());
    request.repeat = static_cast<int>(*repeat);
    const Result<ViewChoice> view = parse_view(arguments.view.value_or("both"));
    if (!view) return fail(view.error());
    request.views = *view;
    return {};
}

Result<void> check_combinations(const BenchArguments& arguments, const BenchRequest& request) {
    const RenderArguments& render = arguments.render;
    const bool by_hand = render.eye || render.target || render.up;
    if (arguments.view && by_hand) {
        return conflict("--view",
                        "it cannot go together with --eye, --target or --up, which are a view of "
                        "their own; give one or the other");
    }
    if (render.camera_model && *render.camera_model != "pinhole") {
        return conflict("--camera-model", "the bench measures through a pinhole; leave it out");
    }
    if (request.plot && request.threads.size() < 2 && request.isas.size() < 2) {
        return conflict("--plot",
                        "there is nothing to draw; give several --threads (1,2,4) or several "
                        "--isa (all)");
    }
    if (arguments.assets && !arguments.scenes.empty()) {
        return conflict("--assets", "it cannot go together with a SCENE; give one or the other");
    }
    for (const auto* name : {&arguments.json, &arguments.plot, &arguments.compare}) {
        if (*name && (*name)->empty()) {
            return conflict("--json, --plot, --compare",
                            "the name is empty; give one or leave out the option");
        }
    }
    return {};
}

/// One scene's request. Quantities take one sample a pixel, so they get more pixels.
Result<RenderRequest> request_for(const BenchArguments& arguments, const std::string& scene) {
    RenderArguments render = arguments.render;
    render.scene_file = scene;
    render.writes_pictures = false;
    for (const auto* output : {&arguments.json, &arguments.plot}) {
        if (*output) render.outputs.push_back(**output);
    }
    if (!render.spp) render.spp = "4";
    Result<RenderRequest> request = make_render_request(render);
    if (request && !render.size) {
        const bool quantity = is_quantity(request->options.integrator);
        request->options.width = quantity ? 1920 : 640;
        request->options.height = quantity ? 1080 : 360;
    }
    if (!request) return request;
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

Result<BenchRequest> make_bench_request(const BenchArguments& arguments) {
    BenchRequest request;
    if (arguments.json) request.json = *arguments.json;
    if (arguments.plot) request.plot = *arguments.plot;
    if (arguments.compare) request.compare = *arguments.compare;
    if (auto parsed = parse_own(arguments, request); !parsed) return fail(parsed.error());
    if (auto sound = check_combinations(arguments, request); !sound) return fail(sound.error());
    Result<std::vector<RenderRequest>> scenes =
        requests_for(arguments.scenes, arguments.assets, [&](const std::string& scene) {
            return request_for(arguments, scene);
        });
    if (!scenes) return fail(scenes.error());
    request.scenes = std::move(*scenes);
    request.verbosity = request.scenes.front().verbosity;
    return request;
}

}  // namespace obscura
