// app/crosscheck_request.cpp - from the texts of `obscura crosscheck` to a checked request.
// SPDX-License-Identifier: Apache-2.0
#include "app/crosscheck_request.h"

#include "app/asset_choice.h"
#include "app/numbers.h"
#include "app/option_steps.h"

namespace obscura {

namespace {

constexpr uint64_t most_rays = 1000000000000;

Result<TrueRay> parse_ray(const std::string& text) {
    const Result<std::vector<double>> numbers =
        parse_numbers(text,
                      "--ray",
                      {"ox,oy,oz,dx,dy,dz: where the ray begins and its direction; a seventh, its "
                       "end, in lengths "
                       "of the direction",
                       6,
                       7,
                       -1e18,
                       1e18});
    if (!numbers) return fail(numbers.error());
    const std::vector<double>& n = *numbers;
    TrueRay ray{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    if (n.size() > 6) ray.end = n[6];
    if (static_cast<float>(length(ray.direction)) > 0.0f) return ray;
    return fail(ExitCode::usage, "E-USAGE-RANGE", "--ray", "the direction must not be 0,0,0");
}

Result<void> check_combinations(const CrosscheckArguments& arguments) {
    OptionSteps steps;
    const bool many = arguments.scenes.size() != 1;
    steps.refuse(arguments.assets && !arguments.scenes.empty(),
                 "--assets",
                 "it cannot go together with a SCENE; give one or the other");
    steps.refuse(arguments.ray && many, "--ray", "it needs one SCENE");
    steps.refuse(arguments.image && many, "--image", "it needs one SCENE");
    steps.refuse(arguments.export_embree && many, "--export-embree", "it needs one SCENE");
    steps.refuse(arguments.ray && (arguments.json || arguments.image || arguments.export_embree),
                 "--ray",
                 "it prints one ray and writes no file; leave out --json, --image and "
                 "--export-embree");
    for (const auto* name : {&arguments.json, &arguments.image, &arguments.export_embree}) {
        steps.refuse(*name && (*name)->empty(),
                     "--json, --image, --export-embree",
                     "the name is empty; give one or leave out the option");
    }
    return steps.done();
}

/// One scene's request.
Result<RenderRequest> request_for(const CrosscheckArguments& arguments, const std::string& scene) {
    RenderArguments render = arguments.render;
    render.scene_file = scene;
    render.writes_pictures = false;
    if (!render.size) render.size = "640x360";
    for (const auto* output : {&arguments.json, &arguments.image}) {
        if (*output) render.outputs.push_back(**output);
    }
    return make_render_request(render);
}

}  // namespace

Result<uint64_t> parse_count(const std::string& text, const std::string& option) {
    std::string digits = text;
    uint64_t factor = 1;
    const auto suffix = [&](char letter, uint64_t times) {
        if (digits.empty() || digits.back() != letter) return;
        digits.pop_back();
        factor = times;
    };
    if (is_index(digits)) {
        factor = 1;
    } else if (text.find_last_of("kMG") + 1 == text.size()) {
        const char letter = text.empty() ? ' ' : text.back();
        suffix(letter, letter == 'k' ? 1000 : letter == 'M' ? 1000000 : 1000000000);
    }
    if (!is_index(digits)) {
        return fail(ExitCode::usage,
                    "E-USAGE-NUMBER",
                    option,
                    in_quotes(text) +
                        " is not accepted; expected a whole number, or one with k, "
                        "M or G behind it, such as 10M");
    }
    const Result<uint64_t> number = parse_unsigned(digits, option);
    if (!number) return number;
    if (*number >= 1 && *number <= most_rays / factor) return *number * factor;
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                option,
                in_quotes(text) + " is out of range; expected 1 to 1000G");
}

Result<CrosscheckRequest> make_crosscheck_request(const CrosscheckArguments& arguments) {
    CrosscheckRequest request;
    if (auto sound = check_combinations(arguments); !sound) return fail(sound.error());
    OptionSteps steps;
    steps.option(
        arguments.rays,
        [](const std::string& text) { return parse_count(text, "--rays"); },
        [&](uint64_t rays) { request.rays = rays; });
    steps.option(arguments.ray, parse_ray, [&](const TrueRay& ray) { request.ray = ray; });
    if (auto done = steps.done(); !done) return fail(done.error());
    if (arguments.json) request.json = *arguments.json;
    if (arguments.image) request.image = *arguments.image;
    if (arguments.export_embree) request.export_embree = *arguments.export_embree;
    Result<std::vector<RenderRequest>> scenes =
        requests_for(arguments.scenes, arguments.assets, [&](const std::string& scene) {
            return request_for(arguments, scene);
        });
    if (!scenes) return fail(scenes.error());
    request.scenes = std::move(*scenes);
    return request;
}

}  // namespace obscura
