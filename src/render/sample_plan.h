// render/sample_plan.h - adaptive sampling decides: numbers of samples, and which pixels get more.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace obscura {

/// The numbers of samples that pixels stop at, ascending: half of the least one, so that its
/// samples have two parts; the least one and its doubles; numbers halfway between two of these, if
/// they are multiples of 16; and the most one. A pixel's samples stay well stratified.
///
/// In      2 <= least <= most
std::vector<int> sample_levels(int least, int most);

/// Groups of pixels that are sampled alike.
struct GroupSamples {
    std::span<const float> deviations;  ///< of film/noise.h
    std::span<const int> samples;       ///< of each pixel, so far
    std::span<const float> costs;       ///< what a sample takes: rays
    std::span<const int> sizes;         ///< pixels in the group, possibly none
};

/// The numbers of samples to go on to, of each group: those that it has, or a level above them. The
/// error of a picture falls fastest with the rays traced when each pixel has samples in proportion
/// to its deviation and to the inverse square root of their cost (Neyman allocation); the factor is
/// the one with which the picture reaches its goal. Pixels for which the most samples are not
/// enough count as far as these go: they do not make the others take more. A group goes on to the
/// level that is nearest to its share, as a ratio, but at most to the double of what it has, or the
/// next level: then the noise is known better.
///
/// In      noise: of the picture, that is to be reached (image_noise)
///         levels: sample_levels; samples are at most the last
/// Source  Neyman, "On the Two Different Aspects of the Representative Method", 1934;
///         Cochran, "Sampling Techniques", 1977, section 5.5, for samples that differ in cost
std::vector<int> next_samples(const GroupSamples& groups,
                              double noise,
                              std::span<const int> levels);

}  // namespace obscura
