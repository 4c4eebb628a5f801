// denoise/candidates.h - filtered images, to be mixed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/frame.h"

#include <span>

namespace obscura {

/// Both halves, filtered with the same weights.
struct FilteredHalves {
    Rgb halves[2];
    Plane brightness_root;  ///< a mean that a few bright neighbours hardly change
    Plane weight;           ///< sum of the weights
};

using Candidates = std::array<FilteredHalves, candidate_count>;

/// In      frames: the image that is filtered, then neighbours whose pixels count, too
Candidates filter_halves(std::span<const Frame> frames);

/// Shares of the filters and of the noisy image in a pixel; they add up to 1.
struct Mix {
    std::array<Plane, candidate_count> filtered;
    Plane noisy;
};

/// The mixed image of both halves.
///
/// In      first_share: of the samples that are in the first half
Rgb mixed_halves(const FilterGuides& guides,
                 const Candidates& candidates,
                 const Mix& mix,
                 float first_share);

/// Filters the layers of the frames with the same weights.
std::vector<Rgb> filter_layers(std::span<const Frame> frames,
                               const Candidates& candidates,
                               const Mix& mix);

}  // namespace obscura
