// app/layer_options.cpp - the options for layers beside the beauty: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/layer_options.h"

#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/render_request.h"
#include "base/text.h"
#include "film/layers.h"
#include "film/light_path_plan.h"
#include "session/denoising.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <sstream>

namespace obscura::app {

namespace {

using A = RenderArguments;
using L = LayerArguments;
using R = RenderRequest;
using X = ExrOptions;
using Entry = OptionEntry<A, R>;

constexpr std::array<Choice<ExrLayout>, 3> exr_layouts = {{{"single", ExrLayout::single},
                                                           {"multipart", ExrLayout::multipart},
                                                           {"separate", ExrLayout::separate}}};

/// There is one choice.
Result<void> check_light_groups(const OptionInfo& info, const std::string& text, R& /*request*/) {
    if (text == "each") return {};
    return fail(ExitCode::usage,
                "E-USAGE-CHOICE",
                info.name,
                in_quotes(text) +
                    " is not accepted; expected each. To name groups use "
                    "--light-group NAME=PATTERN");
}

/// The table of --list-aovs.
std::string list_of_layers() {
    std::string out =
        fmt::format("{:<24}{:<10}{:<13}{}\n", "layer", "channels", "a pixel is", "what");
    for (const LayerDescription& layer : all_layers()) {
        out += fmt::format("{:<24}{:<10}{:<13}{}{}\n",
                           layer.name,
                           layer.channels,
                           layer.reduction,
                           layer.help,
                           layer.expression.empty() ? "" : ": " + layer.expression);
    }
    return out;
}

// clang-format off
constexpr Entry layers[] = {
    {{.name = "--aov", .argument = "NAME[,NAME...]",
      .help = "Layers beside the beauty, from the same samples: an EXR holds them as NAME.X and so "
              "on. May be given several times; --list-aovs lists them", .fallback = "none"},
     text_at<&A::aovs>},
    {{.name = "--lpe", .argument = "NAME=EXPRESSION",
      .help = "A layer of the light whose paths a light path expression accepts, such as "
              "key_gloss=C<R[GS]>+<L'key'>. May be given several times", .fallback = "none"},
     text_at<&A::layer, &L::lpe>},
    {{.name = "--light-group", .argument = "NAME=PATTERN[,PATTERN...]",
      .help = "A layer light_NAME of the light that comes from these: lights, materials, nodes "
              "with all below them, or env, the environment. * and ? stand for any text and "
              "letter. May be given several times; a light is in the first group that it fits, and "
              "light_rest has what fits none", .fallback = "none", .excludes = {"--light-groups"}},
     text_at<&A::layer, &L::light_group>},
    {{.name = "--light-groups", .argument = "each",
      .help = "A layer for every light, every material that emits, and the environment",
      .fallback = "none"},
     text_at<&A::layer, &L::light_groups>, {.read = check_light_groups}},
    {{.name = "--light-groups-components",
      .help = "And for each of them the components, such as diffuse_direct_NAME",
      .needs = {"--light-group", "--light-groups"}},
     text_at<&A::layer, &L::light_groups_components>},
    {{.name = "--exr-layout", .argument = "NAME",
      .help = "Where layers lie: in the beauty's part of the EXR, in a part each, or in a file "
              "each beside it, such as shot.normal.exr:"},
     text_at<&A::exr_layout>, choice_at<exr_layouts, &R::exr, &X::layout>},
    {{.name = "--crypto-levels", .argument = "N",
      .help = "How many ids a pixel of a Cryptomatte layer keeps, those that cover most of it",
      .range = {1, 64}, .needs = {"--aov"}},
     text_at<&A::crypto_levels>, number_at<&R::crypto_levels>},
    {{.name = "--crypto-manifest", .argument = "FILE.json",
      .help = "Write the names that Cryptomatte's ids stand for into this file, in the folder of "
              "the EXR, which then has the file's name in their place",
      .fallback = "in the EXR", .files = "json", .needs = {"--aov"}},
     text_at<&A::crypto_manifest>, name_at<&R::crypto_manifest>},
    {{.name = "--list-aovs", .help = "Print the layers that --aov knows, and do nothing else",
      .prints = list_of_layers},
     text_at<&A::list_aovs>}};

constexpr Entry denoising[] = {
    {{.name = "--denoise",
      .help = "Take the noise out of the beauty and of the layers of the light, guided by albedo, "
              "normal and depth and by the difference of two halves of the samples"},
     text_at<&A::layer, &L::denoise>},
    {{.name = "--keep-noisy",
      .help = "And keep the beauty as it was in the layer noisy", .needs = {"--denoise"}},
     text_at<&A::layer, &L::keep_noisy>},
    {{.name = "--denoising-data",
      .help = "Store what `obscura denoise` needs later: half_1 and half_2, albedo_half_1, "
              "albedo_half_2, normal_half_1, normal_half_2, depth and opacity, and all colours as "
              "32-bit floats",
      .excludes = {"--denoise"}},
     text_at<&A::layer, &L::denoising_data>}};

// clang-format on

/// The layers of --aov and --lpe.
Result<void> read_named_layers(const RenderArguments& arguments, RenderRequest& request) {
    std::vector<std::string> names;
    for (const std::string& list : arguments.aovs) {
        std::istringstream parts(list);
        for (std::string name; std::getline(parts, name, ',');)
            names.push_back(name);
    }
    const Result<void> chosen = choose_layers(names, request);
    if (!chosen) return chosen;
    for (const std::string& text : arguments.layer.lpe) {
        Result<Layer> layer = light_layer_of(text);
        if (!layer) return fail(layer.error());
        request.options.layers.push_back(std::move(*layer));
    }
    return {};
}

/// --denoising-data: one file that has all that --denoise takes from the samples, and not rounded.
Result<void> add_denoising_data(RenderRequest& request) {
    const ExrCompression codec = request.exr.compression;
    if (codec == ExrCompression::pxr24 || codec == ExrCompression::dwaa ||
        codec == ExrCompression::dwab) {
        return conflict("--compression",
                        "it would round what --denoising-data stores; use none, rle, zips, zip, "
                        "piz, b44 or b44a");
    }
    if (request.exr.layout == ExrLayout::separate) {
        return conflict("--exr-layout",
                        "`obscura denoise` reads one file; use single or multipart with "
                        "--denoising-data");
    }
    if (auto fits = check_denoising(request.options, "--denoising-data"); !fits) return fits;
    add_denoising_layers(request.options);
    request.exr.depth = ExrDepth::float32;
    return {};
}

/// The layers of light groups that have names already; the scene gives the others theirs.
Result<void> read_light_groups(const LayerArguments& arguments, RenderRequest& request) {
    LightGroupOptions& groups = request.options.light_groups;
    groups.each = arguments.light_groups.has_value();
    groups.components = arguments.light_groups_components;
    for (const std::string& text : arguments.light_group) {
        Result<LightGroupPattern> group = parse_light_group(text);
        if (!group) return fail(group.error());
        const auto is_same = [&](const auto& other) { return other.name == group->name; };
        if (std::any_of(groups.groups.begin(), groups.groups.end(), is_same)) {
            return fail(ExitCode::usage,
                        "E-LIGHT-GROUP",
                        "--light-group",
                        "two groups are called " + in_quotes(group->name) +
                            "; one takes several patterns, NAME=PATTERN,PATTERN");
        }
        groups.groups.push_back(std::move(*group));
    }
    if (groups.each && request.exr.layout == ExrLayout::separate) {
        return conflict("--exr-layout",
                        "the files of --light-groups each would be called after what is in the "
                        "scene; use single or multipart, or name groups with --light-group");
    }
    if (groups.each || groups.groups.empty()) return {};
    for (Layer& layer : light_group_layers(names_of_groups(groups), groups.components))
        request.options.layers.push_back(std::move(layer));
    return {};
}

}  // namespace

const char* layer_option_of(const RenderArguments& arguments) {
    if (!arguments.aovs.empty()) return "--aov";
    if (!arguments.layer.lpe.empty()) return "--lpe";
    if (arguments.layer.keep_noisy) return "--keep-noisy";
    if (arguments.layer.denoising_data) return "--denoising-data";
    return arguments.layer.light_groups ? "--light-groups" : "--light-group";
}

Result<void> read_layers(const RenderArguments& arguments, RenderRequest& request) {
    const Result<void> named = read_named_layers(arguments, request);
    if (!named) return named;
    request.denoise = arguments.layer.denoise;
    if (request.denoise) {
        if (auto fits = check_denoising(request.options, "--denoise"); !fits) return fits;
    }
    if (arguments.layer.denoising_data) {
        if (auto stored = add_denoising_data(request); !stored) return stored;
    }
    if (arguments.layer.keep_noisy) request.options.layers.push_back(noisy_layer());
    const Result<void> grouped = read_light_groups(arguments.layer, request);
    if (!grouped) return grouped;
    std::set<std::string> names;
    for (const Layer& layer : request.options.layers) {
        if (!names.insert(layer.name).second)
            return conflict(arguments.layer.lpe.empty() ? layer_option_of(arguments) : "--lpe",
                            "two layers are called " + in_quotes(layer.name));
    }
    return check_layers(request, layer_option_of(arguments));
}

OptionGroup<A, R> layer_group() {
    return {"Layers", layers};
}

OptionGroup<A, R> denoising_group() {
    return {"Denoising", denoising};
}

}  // namespace obscura::app
