// denoise/weights.h - how much each pixel near a pixel tells of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/planes.h"

#include <array>
#include <type_traits>
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

/// Rows of values: of a plane, or of a buffer for a tile.
template <typename Value>
struct Rows {
    Value* first;
    size_t stride;
};

/// Rows of a plane from a pixel on.
template <typename AnyPlane>
auto rows_of(AnyPlane& plane, int x, int y) {
    const auto stride = static_cast<size_t>(plane.row(1) - plane.row(0));
    return Rows<std::remove_pointer_t<decltype(plane.row(0))>>{plane.row(y) + x, stride};
}

/// Adds the weights of a tile's pixels, in rows of WeightTile::side, to sums of that form.
void add_weights(const WeightTile& tile, const float* weights, float* sums);

/// Adds the values of a tile's pixels, or of neighbours of them, times these weights.
void add_weighted(const WeightTile& tile,
                  const float* weights,
                  Rows<const float> values,
                  Rows<float> sums);

/// Two halves of an image, and how noisy it is.
struct NoisyHalves {
    const Rgb* halves;
    const Plane& variance;  ///< of the halves' mean, summed over the channels, above 0
};

/// How much the surroundings of two pixels differ, by two halves of a noisy image.
class PatchDistances {
public:
    /// In      of: the image whose pixels are compared with those of `others`, which may be `of`
    PatchDistances(const NoisyHalves& of, const NoisyHalves& others, const WeightTile& tile);

    /// Compares every pixel of the tile with the one `dx`, `dy` away: squared differences over
    /// variances. Each square is the product of the differences in the two halves, whose noise is
    /// independent: its mean is what it would be without noise, and where nothing differs it may
    /// be negative.
    void compute(int dx, int dy);

    const float* row(int y) const { return distances_.data() + y * WeightTile::side; }

    /// Weights by these distances alone, in rows of WeightTile::side.
    void weigh(std::vector<float>& weights) const;

private:
    void compare_pixels(int dx, int dy);

    static constexpr int padded = WeightTile::side + 2 * patch_radius;
    NoisyHalves of_, others_;
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

/// What weights are made of. An image that another one is compared with needs neither nearness nor
/// slopes: its pixels show what those of the other do.
struct FilterGuides {
    Rgb halves[2];           ///< colours of the two halves, divided by what the surface reflects
    Plane variance;          ///< of their mean, summed over the channels
    Plane aliasing;          ///< share of it that edges and textures make
    Plane brightness_root;   ///< the fourth root of their mean's brightness
    Rgb normal, albedo;      ///< in units of what counts as different
    Plane feature_variance;  ///< of these, summed
    Plane nearness;          ///< 1 / depth: over a plane in perspective it is linear
    Plane slope_x, slope_y;  ///< of nearness, from pixel to pixel
    Plane share;             ///< how much a pixel counts: its alpha; 0 outside of the image
};

/// The filters that a pixel chooses from: `detail` compares colours and features, `smooth` features
/// alone.
enum Candidate : size_t { detail, smooth, candidate_count };

/// How much the features of two pixels differ.
class FeatureDistances {
public:
    /// In      of: the image whose pixels are compared with those of `others`, which may be `of`
    FeatureDistances(const FilterGuides& of, const FilterGuides& others, const WeightTile& tile);

    /// Compares every pixel of the tile with the one `dx`, `dy` away.
    void compute(int dx, int dy);

    const float* row(int y) const { return distances_.data() + y * WeightTile::side; }

    /// Weights by these distances alone, in rows of WeightTile::side.
    void weigh(int dx, int dy, std::vector<float>& weights) const;

private:
    const FilterGuides& of_;
    const FilterGuides& others_;
    WeightTile tile_;
    std::vector<float> distances_;
};

/// The weights of one neighbour of every pixel of a tile.
class TileWeights {
public:
    /// In      of: the image that is filtered; others: the one whose pixels count, often the same
    TileWeights(const FilterGuides& of, const FilterGuides& others, const WeightTile& tile);

    /// Computes the weights of the neighbours `dx`, `dy` away.
    void compute(int dx, int dy);

    /// In rows of WeightTile::side.
    const float* of(size_t candidate) const { return weights_[candidate].data(); }

private:
    void weigh(int dx, int dy);

    const FilterGuides& others_;
    WeightTile tile_;
    PatchDistances colors_;
    FeatureDistances features_;
    std::array<std::vector<float>, candidate_count> weights_;
};

}  // namespace obscura
