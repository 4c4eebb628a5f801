// film/noise.h - how noisy the pixels of an unfinished image are, by what more samples changed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace obscura {

/// An image whose pixels may have different numbers of samples, and the same one before the latest
/// samples of each pixel.
struct SampledImage {
    int width = 0, height = 0;
    size_t channels = 0;  ///< of which the first three are colours
    std::span<const float> pixels, before;
    std::span<const int> samples,
        samples_before;  ///< of each pixel; more than before, which is > 0
    double white = 1;    ///< radiance that is displayed as white
};

/// The relative standard deviation of one sample of every pixel: the error of a pixel's mean of n
/// samples is this over the square root of n. It is relative to the colour around the pixel, but at
/// least to `darkest_error_white` of white, as an eye would judge it.
///
/// The two parts of a pixel's samples are independent estimates of it. How far they differ says
/// little for one pixel, so that the mean over its neighbourhood stands for it. The pixel itself
/// does not count: were it sampled further because its own samples happened to be bright, the mean
/// of the image would become too dark. Rare bright light thus calls for samples around where it was
/// found.
///
/// Source  Kirk, Arvo, "Unbiased Sampling Techniques for Image Synthesis", SIGGRAPH 1991, for the
///         bias of samples that decide over their own pixel
std::vector<float> sample_deviations(const SampledImage& image);

/// Below this fraction of white an error counts as that of this brightness.
inline constexpr double darkest_error_white = 0.1;

/// Side of the square neighbourhood of a pixel.
inline constexpr int noise_window = 7;

/// The relative error of an image: the root of the mean square of its pixels' errors.
double image_noise(std::span<const float> deviations, std::span<const int> samples);

}  // namespace obscura
