// denoise/candidates.h - filtered images, and which of them is best at each pixel.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/weights.h"

#include <span>

namespace obscura {

/// Both halves, filtered with the same weights.
struct FilteredHalves {
    Rgb halves[2];
    Plane weight;  ///< sum of the weights
};

using Candidates = std::array<FilteredHalves, candidate_count>;

Candidates filter_halves(const FilterGuides& guides);

/// Shares of the filters and of the noisy image in a pixel; they add up to 1.
struct Mix {
    std::array<Plane, candidate_count> filtered;
    Plane noisy;
};

/// Estimates each filter's error at each pixel, and mixes them by it. The squared bias is the mean
/// of the product of what the filter changes in either half, whose noise is independent; the
/// variance is what the two filtered halves differ by. An unfiltered pixel has variance alone.
Mix mix_candidates(const FilterGuides& guides, const Candidates& candidates);

/// The mixed image of both halves.
///
/// In      first_share: of the samples that are in the first half
Rgb mixed_halves(const FilterGuides& guides,
                 const Candidates& candidates,
                 const Mix& mix,
                 float first_share);

/// Filters further images, three planes each, with the same weights.
std::vector<Rgb> filter_images(const FilterGuides& guides,
                               const Candidates& candidates,
                               const Mix& mix,
                               std::span<const Rgb> images);

}  // namespace obscura
