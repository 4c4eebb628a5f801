// app/lens_options.h - the options for cameras beyond the pinhole: texts and table.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"

namespace obscura {
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

/// The texts of these options as they stood on the command line.
struct LensArguments {
    using Text = OptionText;
    Text camera_json, near_m, far_m, magnification, focal_length, sensor, shift, distortion;
    Text fstop, lens_radius, focus_distance, focus_on;
    Text blades, blade_rotation, anamorphic, aperture;
    Text fisheye, fisheye_fit, fisheye_coefficients;
    Text environment, stereo, align;
    Text shutter, iso, ev100;
};

struct RenderArguments;

/// Each group has its own heading.
std::span<const OptionGroup<RenderArguments, RenderRequest>> lens_option_groups();

}  // namespace obscura::app
