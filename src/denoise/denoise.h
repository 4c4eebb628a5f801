// denoise/denoise.h - takes the noise out of an image, guided by its features and two half images.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

namespace obscura {

/// Both halves of the samples: interleaved, three channels, rows from the top.
using Halves = std::array<std::span<const float>, 2>;

/// What the filter learns its weights from.
struct DenoiseInput {
    int width = 0, height = 0;
    Halves color;                    ///< premultiplied
    Halves albedo, normal;           ///< 0 where a sample hits nothing
    std::span<const float> depth;    ///< metres, one channel; 0: nothing
    std::span<const float> opacity;  ///< one channel: the share of samples that hit something
    std::span<const float> alpha;    ///< one channel; empty: 1 everywhere
    std::span<const float> motion;  ///< four channels as of Aov::motion, where there are neighbours
    float first_share = 0.5f;       ///< of the samples that are in the first half
};

/// An image of light that is filtered in place: its first three channels.
struct LightImage {
    std::span<float> pixels;
    size_t channels = 3;
};

/// Another image of the same size: one frame before or after.
struct NeighborFrame {
    bool is_after = false;
    DenoiseInput input;
    std::vector<LightImage> layers;  ///< shares of its light, as of the image that is filtered
};

struct DenoiseReport {
    double outlier_share = 0;  ///< of the pixels: with light that was given to their neighbours
};

/// Filters the beauty, and with the beauty's weights its layers, so that those that added up to it
/// still do: all that is done is linear in the light once the input is given. The light of the
/// whole image stays the same. Where the halves are equal in a pixel and around it, it is not
/// changed, and pixels without alpha never are. Any number of threads gives the same bits.
///
/// In      images: the mean of both halves, then shares of it
///         neighbors: whose pixels count, too, where they show what the image shows
/// Source  Rousselle, Manzi, Zwicker, "Robust Denoising using Feature and Color Information", 2013;
///         Bitterli et al., "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo
///         Renderings", 2016 (features cleaned first, candidates chosen by their estimated errors)
DenoiseReport denoise(const DenoiseInput& input,
                      std::span<const LightImage> images,
                      std::span<const NeighborFrame> neighbors = {});

}  // namespace obscura
