// denoise/frame.h - an image as the filter looks at it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/denoise.h"
#include "denoise/weights.h"

#include <vector>

namespace obscura {

/// Size of an image, to make planes of.
struct PlaneSize {
    int width, height;

    template <typename Value>
    Plane plane(const Value& value) const {
        return make_plane(width, height, plane_border, value);
    }
    size_t index(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    }
    Rgb rgb(std::span<const float> pixels, size_t channels) const {
        Rgb out;
        for (size_t c = 0; c < 3; ++c)
            out[c] = plane([&](int x, int y) { return pixels[index(x, y) * channels + c]; });
        return out;
    }
};

Rgb product(const Rgb& a, const Rgb& b);

/// An image with its features cleaned, its colours divided by what the surface reflects, and its
/// outliers lowered.
struct Frame {
    FilterGuides guides;
    Rgb reflected;            ///< by what colours are divided
    Rgb kept;                 ///< share of a pixel's light that outliers leave
    std::vector<Rgb> layers;  ///< shares of the light, divided and lowered as the colours are
    double outlier_share = 0;
};

/// Leaves out FilterGuides::aliasing, which only the frame that is filtered needs.
Frame make_frame(const DenoiseInput& input, std::span<const LightImage> layers);

/// The share of the noise that edges and textures make.
Plane aliasing_of(const DenoiseInput& input, const Frame& frame);

}  // namespace obscura
