// denoise/weights.h - how much each pixel near a pixel tells of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/planes.h"

#include <array>
#include <vector>

namespace obscura {

/// Pixels that the filter looks at on every side of a pixel.
inline constexpr int window_radius = 8;
/// Pixels on every side of two pixels whose surroundings are compared.
inline constexpr int patch_radius = 2;
/// Border of all planes.
inline constexpr int plane_border = window_radius + patch_radius;

/// A part of the image, at most WeightTile::side a side.
struct WeightTile {
    static constexpr int side = 64;
    int x = 0, y = 0, width = 0, height = 0;
};

std::vector<WeightTile> weight_tiles(int width, int height);

/// How much the surroundings of two pixels differ, by two halves of a noisy image.
class PatchDistances {
public:
    /// In      variance: of the halves' mean, summed over the channels, above 0
    PatchDistances(const Rgb* halves, const Plane& variance, const WeightTile& tile);

    /// Compares every pixel of the tile with the one `dx`, `dy` away: squared differences over
    /// variances. Each square is the product of the differences in the two halves, whose noise is
    /// independent: its mean is what it would be without noise, and where nothing differs it may
    /// be negative.
    void compute(int dx, int dy);

    const float* row(int y) const { return distances_.data() + y * WeightTile::side; }

private:
    void compare_pixels(int dx, int dy);

    static constexpr int padded = WeightTile::side + 2 * patch_radius;
    const Rgb* halves_;
    const Plane& variance_;
    WeightTile tile_;
    std::vector<float> differences_, across_, distances_;
};

/// exp(-x) to within 0.036 for x >= 0 and 1 below; 0 from 8 on: products alone.
inline float falloff(float x) {
    const float base = std::clamp(1.0f - x * 0.125f, 0.0f, 1.0f);
    const float square = base * base;
    const float fourth = square * square;
    return fourth * fourth;
}

/// What weights are made of.
struct FilterGuides {
    Rgb halves[2];           ///< colours of the two halves, divided by what the surface reflects
    Plane variance;          ///< of their mean, summed over the channels
    Rgb normal, albedo;      ///< in units of what counts as different
    Plane feature_variance;  ///< of these, summed
    Plane nearness;          ///< 1 / depth: over a plane in perspective it is linear
    Plane slope_x, slope_y;  ///< of nearness, from pixel to pixel
    Plane share;             ///< how much a pixel counts: its alpha; 0 outside of the image
};

/// The filters that a pixel chooses from: `detail` compares colours and features, `smooth` features
/// alone.
enum Candidate : size_t { detail, smooth, candidate_count };

/// The weights of one neighbour of every pixel of a tile.
class TileWeights {
public:
    TileWeights(const FilterGuides& guides, const WeightTile& tile);

    /// Computes the weights of the neighbours `dx`, `dy` away.
    void compute(int dx, int dy);

    const float* row(Candidate candidate, int y) const {
        return weights_[candidate].data() + y * WeightTile::side;
    }

private:
    void compare_features(int dx, int dy);

    const FilterGuides& guides_;
    WeightTile tile_;
    PatchDistances colors_;
    std::vector<float> features_;
    std::array<std::vector<float>, candidate_count> weights_;
};

}  // namespace obscura
