// denoise/weights.cpp - how much each pixel near a pixel tells of it.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/weights.h"

#include "base/per_cpu.h"

namespace obscura {

namespace {

/// Three planes at a pixel.
struct RgbRows {
    const float* r;
    const float* g;
    const float* b;
};

RgbRows rows_of(const Rgb& from, int x, int y) {
    return {from[0].row(y) + x, from[1].row(y) + x, from[2].row(y) + x};
}

float squared_distance(RgbRows a, RgbRows b, int i) {
    const float x = a.r[i] - b.r[i];
    const float y = a.g[i] - b.g[i];
    const float z = a.b[i] - b.b[i];
    return x * x + y * y + z * z;
}

}  // namespace

std::vector<WeightTile> weight_tiles(int width, int height) {
    std::vector<WeightTile> tiles;
    constexpr int side = WeightTile::side;
    for (int y = 0; y < height; y += side) {
        for (int x = 0; x < width; x += side)
            tiles.push_back({x, y, std::min(side, width - x), std::min(side, height - y)});
    }
    return tiles;
}

OBSCURA_PER_CPU void add_weights(const WeightTile& tile, const float* weights, float* sums) {
    for (int row = 0; row < tile.height; ++row) {
        for (int i = row * WeightTile::side; i < row * WeightTile::side + tile.width; ++i)
            sums[i] += weights[i];
    }
}

OBSCURA_PER_CPU void add_weighted(const WeightTile& tile,
                                  const float* weights,
                                  Rows<const float> values,
                                  Rows<float> sums) {
    for (int row = 0; row < tile.height; ++row) {
        for (int i = 0; i < tile.width; ++i)
            sums.first[i] += weights[i] * values.first[i];
        weights += WeightTile::side;
        values.first += values.stride;
        sums.first += sums.stride;
    }
}

PatchDistances::PatchDistances(const NoisyHalves& of,
                               const NoisyHalves& others,
                               const WeightTile& tile)
    : of_(of),
      others_(others),
      tile_(tile),
      differences_(padded * padded),
      across_(WeightTile::side * padded),
      distances_(WeightTile::side * WeightTile::side) {}

OBSCURA_PER_CPU void PatchDistances::compare_pixels(int dx, int dy) {
    for (int row = 0; row < tile_.height + 2 * patch_radius; ++row) {
        const int y = tile_.y + row - patch_radius;
        const int x = tile_.x - patch_radius;
        const RgbRows p1 = rows_of(of_.halves[0], x, y);
        const RgbRows q1 = rows_of(others_.halves[0], x + dx, y + dy);
        const RgbRows p2 = rows_of(of_.halves[1], x, y);
        const RgbRows q2 = rows_of(others_.halves[1], x + dx, y + dy);
        const float* const variance_p = of_.variance.row(y) + x;
        const float* const variance_q = others_.variance.row(y + dy) + x + dx;
        float* const out = differences_.data() + row * padded;
        for (int i = 0; i < tile_.width + 2 * patch_radius; ++i) {
            const float product = (p1.r[i] - q1.r[i]) * (p2.r[i] - q2.r[i]) +
                                  (p1.g[i] - q1.g[i]) * (p2.g[i] - q2.g[i]) +
                                  (p1.b[i] - q1.b[i]) * (p2.b[i] - q2.b[i]);
            out[i] = product / (variance_p[i] + variance_q[i]);
        }
    }
}

OBSCURA_PER_CPU void PatchDistances::compute(int dx, int dy) {
    constexpr int patch = 2 * patch_radius + 1;
    constexpr float mean = 1.0f / (patch * patch);
    compare_pixels(dx, dy);
    for (int row = 0; row < tile_.height + 2 * patch_radius; ++row) {
        const float* const in = differences_.data() + row * padded;
        float* const out = across_.data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i) {
            float sum = 0;
            for (int d = 0; d < patch; ++d)
                sum += in[i + d];
            out[i] = sum * mean;
        }
    }
    for (int row = 0; row < tile_.height; ++row) {
        const float* const in = across_.data() + row * WeightTile::side;
        float* const out = distances_.data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i) {
            float sum = 0;
            for (int d = 0; d < patch; ++d)
                sum += in[i + d * WeightTile::side];
            out[i] = sum;
        }
    }
}

OBSCURA_PER_CPU void PatchDistances::weigh(std::vector<float>& weights) const {
    for (int row = 0; row < tile_.height; ++row) {
        const float* const distance = this->row(row);
        float* const out = weights.data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i)
            out[i] = falloff(distance[i]);
    }
}

FeatureDistances::FeatureDistances(const FilterGuides& of,
                                   const FilterGuides& others,
                                   const WeightTile& tile)
    : of_(of), others_(others), tile_(tile), distances_(WeightTile::side * WeightTile::side) {}

OBSCURA_PER_CPU void FeatureDistances::compute(int dx, int dy) {
    constexpr float different_depth = 0.02f;  // off the plane, of the sum of both nearnesses
    constexpr float depth_scale = 1.0f / (different_depth * different_depth);
    const auto step_x = static_cast<float>(dx);
    const auto step_y = static_cast<float>(dy);
    for (int row = 0; row < tile_.height; ++row) {
        const int y = tile_.y + row;
        const int x = tile_.x;
        const RgbRows normal_p = rows_of(of_.normal, x, y);
        const RgbRows normal_q = rows_of(others_.normal, x + dx, y + dy);
        const RgbRows albedo_p = rows_of(of_.albedo, x, y);
        const RgbRows albedo_q = rows_of(others_.albedo, x + dx, y + dy);
        const float* const noise_p = of_.feature_variance.row(y) + x;
        const float* const noise_q = others_.feature_variance.row(y + dy) + x + dx;
        const float* const near_p = of_.nearness.row(y) + x;
        const float* const near_q = of_.nearness.row(y + dy) + x + dx;
        const float* const slope_x = of_.slope_x.row(y) + x;
        const float* const slope_y = of_.slope_y.row(y) + x;
        float* const out = distances_.data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i) {
            const float sum =
                squared_distance(normal_p, normal_q, i) + squared_distance(albedo_p, albedo_q, i);
            const float off_plane =
                near_q[i] - near_p[i] - slope_x[i] * step_x - slope_y[i] * step_y;
            const float near = near_p[i] + near_q[i] + 1e-10f;
            out[i] = sum / (1.0f + noise_p[i] + noise_q[i]) +
                     depth_scale * (off_plane * off_plane) / (near * near);
        }
    }
}

OBSCURA_PER_CPU void FeatureDistances::weigh(int dx, int dy, std::vector<float>& weights) const {
    for (int row = 0; row < tile_.height; ++row) {
        const float* const distance = this->row(row);
        const float* const share = others_.share.row(tile_.y + row + dy) + tile_.x + dx;
        float* const out = weights.data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i)
            out[i] = share[i] * falloff(distance[i]);
    }
}

TileWeights::TileWeights(const FilterGuides& of, const FilterGuides& others, const WeightTile& tile)
    : others_(others),
      tile_(tile),
      colors_({of.halves, of.variance}, {others.halves, others.variance}, tile),
      features_(of, others, tile) {
    for (std::vector<float>& weights : weights_)
        weights.resize(WeightTile::side * WeightTile::side);
}

void TileWeights::compute(int dx, int dy) {
    colors_.compute(dx, dy);
    features_.compute(dx, dy);
    weigh(dx, dy);
}

OBSCURA_PER_CPU void TileWeights::weigh(int dx, int dy) {
    // Where colours are compared, too, features may differ more.
    constexpr float feature_weight = 0.5f;
    for (int row = 0; row < tile_.height; ++row) {
        const float* const color = colors_.row(row);
        const float* const feature = features_.row(row);
        const float* const share = others_.share.row(tile_.y + row + dy) + tile_.x + dx;
        float* const detail_out = weights_[detail].data() + row * WeightTile::side;
        float* const smooth_out = weights_[smooth].data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i) {
            smooth_out[i] = share[i] * falloff(feature[i]);
            detail_out[i] = share[i] * falloff(std::max(color[i], feature_weight * feature[i]));
        }
    }
}

}  // namespace obscura
