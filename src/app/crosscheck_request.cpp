// app/crosscheck_request.cpp - turns the option texts of `obscura crosscheck` into a request.
// SPDX-License-Identifier: Apache-2.0
#include "app/crosscheck_request.h"

#include "app/asset_choice.h"
#include "app/crosscheck_options.h"
#include "app/numbers.h"

namespace obscura::app {

namespace {

constexpr uint64_t max_rays = 1000000000000;

/// Options that show one scene need a single scene.
Result<void> check_one_scene(const CrosscheckArguments& arguments) {
    if (arguments.scenes.size() == 1) return {};
    for (const auto& [option, text] : {std::pair{"--ray", &arguments.ray},
                                       std::pair{"--image", &arguments.image},
                                       std::pair{"--export-embree", &arguments.export_embree}}) {
        if (*text) return fail(ExitCode::usage, "E-USAGE-CONFLICT", option, "it needs one SCENE");
    }
    return {};
}

/// One scene's request.
Result<RenderRequest> request_for(const CrosscheckArguments& arguments, const std::string& scene) {
    RenderArguments render = arguments.render;
    render.scene_file = scene;
    render.writes_images = false;
    if (!render.size) render.size = crosscheck_size;
    for (const auto* output : {&arguments.json, &arguments.image}) {
        if (*output) render.outputs.push_back(**output);
    }
    return make_render_request(render);
}

}  // namespace

Result<crosscheck::TrueRay> parse_ray(const std::string& text, const std::string& option) {
    const Result<std::vector<double>> numbers =
        parse_numbers(text,
                      option,
                      {"ox,oy,oz,dx,dy,dz: where the ray begins and its direction; a seventh, its "
                       "end, in lengths "
                       "of the direction",
                       6,
                       7,
                       -1e18,
                       1e18});
    if (!numbers) return fail(numbers.error());
    const std::vector<double>& n = *numbers;
    crosscheck::TrueRay ray{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    if (n.size() > 6) ray.end = n[6];
    if (static_cast<float>(length(ray.direction)) > 0.0f) return ray;
    return fail(ExitCode::usage, "E-USAGE-RANGE", option, "the direction must not be 0,0,0");
}

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
    if (*number >= 1 && *number <= max_rays / factor) return *number * factor;
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                option,
                in_quotes(text) + " is out of range; expected 1 to 1000G");
}

Result<CrosscheckRequest> make_crosscheck_request(const CrosscheckArguments& arguments) {
    CrosscheckRequest request;
    CrosscheckArguments texts = arguments;
    const auto table = crosscheck_option_groups();
    if (auto one = check_one_scene(arguments); !one) return fail(one.error());
    if (auto read = read_options(table, texts, request); !read) return fail(read.error());
    const Command command = crosscheck_command(texts);
    if (auto fit = check_combinations(command.options); !fit) return fail(fit.error());
    Result<std::vector<RenderRequest>> scenes =
        requests_for(arguments.scenes, arguments.assets, [&](const std::string& scene) {
            return request_for(arguments, scene);
        });
    if (!scenes) return fail(scenes.error());
    request.scenes = std::move(*scenes);
    return request;
}

}  // namespace obscura::app
