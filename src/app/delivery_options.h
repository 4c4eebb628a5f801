// app/delivery_options.h - the options for images that others work on: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"

namespace obscura {
struct Overscan;
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

/// The texts of these options as they stood on the command line.
struct DeliveryArguments {
    OptionText overscan, segmentation, color_space;
};

struct RenderArguments;

/// "64" pixels or "10%" of the image's width and height.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE
Result<Overscan> parse_overscan(const std::string& text, const std::string& option);

/// --segmentation: what is rendered has ids, and the file is a PNG.
///
/// Errors  64 E-USAGE-CONFLICT an integrator without layers; E-OUT-FORMAT another ending
Result<void> check_segmentation_request(const RenderRequest& request);

/// For the help group of the image.
OptionGroup<RenderArguments, RenderRequest> overscan_group();

/// With a heading of its own.
OptionGroup<RenderArguments, RenderRequest> color_group();

/// For the group "Layers".
OptionGroup<RenderArguments, RenderRequest> segmentation_group();

}  // namespace obscura::app
