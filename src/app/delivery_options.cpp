// app/delivery_options.cpp - the options for images that others work on: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/delivery_options.h"

#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/render_request.h"
#include "render/integrators.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using D = DeliveryArguments;
using R = RenderRequest;
using Entry = OptionEntry<A, R>;

constexpr double max_overscan_px = 8192;
constexpr double max_overscan_percent = 100;

constexpr OptionReader<R> color_space = {.read = read_parsed<parse_name, &R::color_space>,
                                         .show = nullptr,
                                         .names = rendering_space_names};

// clang-format off
constexpr Entry overscan[] = {
    {{.name = "--overscan", .argument = "PIXELS|PERCENT%",
      .help = "Render so much more on every side: up to 8192 pixels, or a share of the width and "
              "of the height. The data window of an EXR then reaches beyond its display window, "
              "which is the image as without; other formats hold that alone. Not for cameras that "
              "see all around",
      .fallback = "0", .excludes = {"--crop"}},
     text_at<&A::delivery, &D::overscan>, parsed_at<parse_overscan, &R::overscan>}};

constexpr Entry segmentation[] = {
    {{.name = "--segmentation", .argument = "FILE.png",
      .help = "Write a mask for data sets, 16-bit grey: the index of the glTF node, plus 1, that "
              "covers most of each pixel, 0 for nothing; and FILE.json with each visible node's "
              "path, mesh, materials, bounding box and number of pixels",
      .fallback = "none", .files = "png"},
     text_at<&A::delivery, &D::segmentation>, name_at<&R::segmentation>}};
constexpr Entry color[] = {
    {{.name = "--color-space", .argument = "NAME",
      .help = "The linear space in which light is computed, and which EXRs have: textures, "
              "factors, lights and the environment are converted on the way in. A linear space of "
              "the OpenColorIO config, or one of:",
      .fallback = "lin_rec709"},
     text_at<&A::delivery, &D::color_space>, color_space}};
// clang-format on

}  // namespace

Result<Overscan> parse_overscan(const std::string& text, const std::string& option) {
    const bool is_percent = text.ends_with('%');
    const std::string number = is_percent ? text.substr(0, text.size() - 1) : text;
    const Result<double> amount =
        is_percent ? parse_real(number, option, 0, max_overscan_percent)
                   : parse_integer(number, option, 0, static_cast<int64_t>(max_overscan_px))
                         .map([](int64_t pixels) { return static_cast<double>(pixels); });
    if (!amount) return fail(amount.error());
    return Overscan{is_percent ? *amount / 100 : *amount, is_percent};
}

Result<void> check_segmentation_request(const RenderRequest& request) {
    if (!request.segmentation) return {};
    const IntegratorEntry& integrator = entry_of(request.options.integrator);
    if (!has_layers(integrator.value)) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    "--segmentation",
                    std::string("--integrator ") + integrator.name +
                        " has no ids beside it. Use path, direct, raycast or ao");
    }
    if (output_format_of(*request.segmentation) == OutputFormat::png) return {};
    return fail(ExitCode::usage,
                "E-OUT-FORMAT",
                "--segmentation",
                "'" + request.segmentation->string() + "': ids are written as .png alone");
}

OptionGroup<RenderArguments, RenderRequest> overscan_group() {
    return {"Picture", overscan};
}

OptionGroup<RenderArguments, RenderRequest> color_group() {
    return {"Colour", color};
}

OptionGroup<RenderArguments, RenderRequest> segmentation_group() {
    return {"Layers", segmentation};
}

}  // namespace obscura::app
