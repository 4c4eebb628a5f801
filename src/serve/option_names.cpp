// serve/option_names.cpp - the options of `obscura render` that clients may give.
// SPDX-License-Identifier: Apache-2.0
#include "serve/option_names.h"

#include <algorithm>
#include <array>

namespace obscura::serve {

namespace {

// clang-format off
constexpr std::array view_option_names = std::to_array<std::string_view>({
    "size", "spp", "noise-target", "spp-min", "depth", "seed", "filter", "integrator",
    "ao-distance", "wire-width", "denoise", "clamp-direct", "clamp-indirect", "caustics",
    "regularize", "background", "page", "exposure", "view", "display", "no-dither", "scene",
    "variant", "animation", "time", "lenient", "hide", "lights", "catcher", "catcher-reflections",
    "env", "env-intensity", "env-rotation", "camera", "camera-model", "eye", "target", "up", "fov",
    "azimuth", "elevation", "zoom", "mag", "focal-length", "sensor", "shift", "near", "far",
    "fstop", "lens-radius", "focus-distance", "focus-on", "blades", "blade-rotation", "anamorphic",
    "ev100", "shutter", "iso", "fisheye", "fisheye-fit", "environment", "align", "stereo",
    "point-size", "line-width"});

constexpr std::array job_option_names = std::to_array<std::string_view>({
    // lists of pictures
    "turntable", "cameras", "variants", "frames", "fps", "animate-seed",
    // layers
    "aov", "lpe", "light-group", "light-groups", "light-groups-components", "exr-layout",
    "crypto-levels", "keep-noisy", "denoising-data",
    // files
    "float", "compression", "exr-tiles", "exr-mipmap", "bits", "quality", "crop", "overscan",
    "color-space",
    // more of the picture
    "roll", "margin", "frame", "focus-node", "distortion", "fisheye-coefficients", "occlusion",
    "holdout", "camera-invisible", "no-shadow", "transparent-glass",
    "transparent-glass-roughness", "strict"});
// clang-format on

template <typename Names>
bool has_name(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool is_view_option(std::string_view name) {
    return has_name(view_option_names, name);
}

bool is_job_option(std::string_view name) {
    return is_view_option(name) || has_name(job_option_names, name);
}

}  // namespace obscura::serve
