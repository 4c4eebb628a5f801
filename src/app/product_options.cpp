// app/product_options.cpp - the options for images of products: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/product_options.h"

#include "app/option_readers.h"
#include "app/render_request.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using L = gltf::LoadOptions;
using P = ProductArguments;
using R = RenderRequest;
using Entry = OptionEntry<A, R>;

constexpr double brightest_factor = 1e6;

/// "Lamp=0.5" or "Lamp=off".
Result<gltf::LightChoice::Factor> parse_light_factor(const std::string& text,
                                                     const std::string& option) {
    const size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0) {
        return fail(ExitCode::usage,
                    "E-USAGE-CHOICE",
                    option,
                    in_quotes(text) +
                        " is not accepted; expected keep, off, or NAME=X such as "
                        "Lamp=0.5,Rim*=off");
    }
    gltf::LightChoice::Factor out{text.substr(0, equals), 0};
    const std::string factor = text.substr(equals + 1);
    if (factor == "off") return out;
    const Result<double> number = parse_real(factor, option, 0, brightest_factor);
    if (!number) return fail(number.error());
    out.factor = *number;
    return out;
}

/// Adds one of several patterns.
Result<void> read_hidden(const OptionInfo& info, const std::string& text, R& request) {
    const Result<std::string> pattern = parse_name(text, info.name);
    if (!pattern) return fail(pattern.error());
    request.load.hidden.push_back(*pattern);
    return {};
}

// clang-format off
constexpr Entry light_choice[] = {
    {{.name = "--lights", .argument = "keep|off|NAME=X",
      .help = "What becomes of the file's lamps: keep; off, as if the file had none; or "
              "NAME=X,NAME=X, which makes those of a name or of a node X times as bright, or off. "
              "* and ? stand for any text and letter; of several that fit, the last counts",
      .fallback = "keep"},
     text_at<&A::product, &P::lights>, parsed_at<parse_lights, &R::load, &L::lights>}};

constexpr Entry parts[] = {
    {{.name = "--hide", .argument = "PATTERN",
      .help = "Leave out the nodes of this name, with all below them, and what has the mesh or "
              "material of this name. * and ? stand for any text and letter. May be given several "
              "times",
      .fallback = "all is shown"},
     text_at<&A::product, &P::hide>, {.read = read_hidden}}};
// clang-format on

}  // namespace

Result<gltf::LightChoice> parse_lights(const std::string& text, const std::string& option) {
    gltf::LightChoice out;
    out.off = text == "off";
    if (out.off || text == "keep") return out;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const Result<gltf::LightChoice::Factor> factor =
            parse_light_factor(text.substr(begin, end - begin), option);
        if (!factor) return fail(factor.error());
        out.factors.push_back(*factor);
        begin = end + 1;
    }
    return out;
}

OptionGroup<A, R> light_choice_group() {
    return {"Light", light_choice};
}

OptionGroup<A, R> part_group() {
    return {"Parts", parts};
}

}  // namespace obscura::app
