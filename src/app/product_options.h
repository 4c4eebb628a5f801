// app/product_options.h - the options for images of products: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "gltf/load.h"
#include "session/camera_choice.h"

namespace obscura {
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

/// The texts of these options as they stood on the command line.
struct ProductArguments {
    OptionText lights, margin, frame, azimuth, elevation, roll, zoom, focus_node;
    std::vector<std::string> hide, holdout, camera_invisible, no_shadow, catcher;
    bool catcher_reflections = false;
    OptionText transparent_glass, transparent_glass_roughness;
};

struct RenderArguments;

/// "keep", "off", or "NAME=X,NAME=X", where X is a number from 0 to 1e6 or "off". A name may have
/// a = in it, but no comma.
///
/// Errors  64 E-USAGE-CHOICE it is none of these; E-USAGE-NUMBER, E-USAGE-RANGE an X
Result<gltf::LightChoice> parse_lights(const std::string& text, const std::string& option);

/// The options that need each other checked: --camera auto and those of the framing take the place
/// of the file's cameras.
///
/// Errors  64 E-USAGE-CONFLICT an option of the framing beside a camera of the file
Result<void> complete_framing(const ProductArguments& arguments,
                              const OptionText& choice,
                              CameraRequest& camera);

/// Shadow catchers checked against the integrator.
///
/// Errors  64 E-USAGE-CONFLICT it renders none
Result<void> check_catchers(const ProductArguments& arguments, const RenderRequest& request);

/// Those of the framing.
OptionGroup<RenderArguments, RenderRequest> framing_group();

/// Those that choose among the file's lights, for the group "Light", and among its parts.
OptionGroup<RenderArguments, RenderRequest> light_choice_group();
OptionGroup<RenderArguments, RenderRequest> part_group();

}  // namespace obscura::app
