// render/sample_plan.h - adaptive sampling decides: numbers of samples, and which pixels get more.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// The numbers of samples that pixels stop at, ascending: half of the least one, so that its
/// samples have two parts, the least one, its doubles, and the most one. Doubling keeps the samples
/// of a pixel well stratified.
///
/// In      2 <= least <= most
std::vector<int> sample_levels(int least, int most);

/// What a picture's samples are to reach.
struct NoiseGoal {
    double noise = 0.01;  ///< relative error of the picture, as image_noise
    int max_samples = 1;
};

/// Marks the pixels that get more samples. The error of a picture falls fastest for a number of
/// samples when each pixel has samples in proportion to its deviation (Neyman allocation); the
/// factor is the one with which the picture reaches its goal. Pixels for which the most samples are
/// not enough count as far as these go: they do not make the others take more.
///
/// In      deviations: of film/noise.h; samples: of each pixel, so far
/// Out     1 for pixels whose share is more than the square root of 2 times their samples; else 0
/// Source  Neyman, "On the Two Different Aspects of the Representative Method", 1934
std::vector<uint8_t> pixels_in_need(std::span<const float> deviations,
                                    std::span<const int> samples,
                                    const NoiseGoal& goal);

}  // namespace obscura
