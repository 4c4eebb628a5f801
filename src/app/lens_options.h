// app/lens_options.h - the options of `obscura render` that make a camera more than a pinhole.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace obscura {

/// The texts of these options as they stood on the command line.
struct LensArguments {
    using Text = std::optional<std::string>;
    Text camera_json, near_m, far_m, magnification, focal_length, sensor, shift, distortion;
    Text fstop, lens_radius, focus_distance, focus_on;
    Text blades, blade_rotation, anamorphic, aperture;
    Text fisheye, fisheye_fit, fisheye_coefficients;
    Text environment, stereo, align;
    Text shutter, iso, ev100;
};

/// Adds them under headings of their own; `arguments` must live as long as the command.
void add_lens_options(CLI::App& command, LensArguments& arguments);

}  // namespace obscura
