// film/noise.h - how noisy the pixels of an unfinished image are, by what more samples changed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace obscura {

/// The pixels of an image in groups that are sampled alike. The two groups of a block are like the
/// fields of a chessboard: what one is judged by are the pixels of the other colour.
struct PixelGroups {
    static constexpr int block_side = 8;

    int width = 0, height = 0;  ///< of the image

    size_t count() const { return 2 * blocks_in(width) * blocks_in(height); }
    size_t of(int x, int y) const {
        const size_t block = static_cast<size_t>(y / block_side) * blocks_in(width) +
                             static_cast<size_t>(x / block_side);
        return 2 * block + static_cast<size_t>((x + y) % 2);
    }
    /// The number of pixels in each: fewer at the right and lower edges, possibly none.
    std::vector<int> sizes() const;

    static size_t blocks_in(int side) {
        return static_cast<size_t>((side + block_side - 1) / block_side);
    }
};

/// An image whose groups of pixels may have different numbers of samples, and the same one before
/// the latest samples of each.
struct SampledImage {
    int width = 0, height = 0;
    size_t channels = 0;  ///< three colours and alpha, with which they are multiplied; or one grey
    std::span<const float> pixels, before;
    std::span<const int> samples,
        samples_before;  ///< of each group of pixels; more than before, which is > 0
    double white = 1;    ///< radiance that is displayed as white
};

/// The relative standard deviation of one sample of the pixels of every group: the error of a
/// pixel's mean of n samples is this over the square root of n. It is relative to the colour around
/// the pixels, but at least to `darkest_error_white` of white, as an eye would judge it. With alpha
/// it is that of the image over black or over white, whichever is more.
///
/// The two parts of a pixel's samples are independent estimates of it. How far they differ says
/// little for one pixel, so that the mean over its block and a margin around it stands for it, of
/// the pixels of the other colour alone. A pixel does not count for itself: were it sampled further
/// because its own samples happened to be bright, the mean of the image would become too dark. Rare
/// bright light thus calls for samples around where it was found.
///
/// Source  Kirk, Arvo, "Unbiased Sampling Techniques for Image Synthesis", SIGGRAPH 1991, for the
///         bias of samples that decide over their own pixel
std::vector<float> sample_deviations(const SampledImage& image);

/// Below this fraction of white an error counts as that of this brightness.
inline constexpr double darkest_error_white = 0.1;

/// Width of the margin around a block.
inline constexpr int noise_margin = 2;

/// The relative error of an image: the root of the mean square of its pixels' errors.
///
/// In      deviations, samples: of each group of pixels
double image_noise(std::span<const float> deviations,
                   std::span<const int> samples,
                   const PixelGroups& groups);

}  // namespace obscura
