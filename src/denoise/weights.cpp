// denoise/weights.cpp - how much each pixel near a pixel tells of it.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/weights.h"

namespace obscura {

namespace {

/// Three planes at a pixel.
struct RgbRows {
    const float* c[3];

    RgbRows(const Rgb& from, int x, int y)
        : c{from[0].row(y) + x, from[1].row(y) + x, from[2].row(y) + x} {}
};

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

PatchDistances::PatchDistances(const Rgb* halves, const Plane& variance, const WeightTile& tile)
    : halves_(halves),
      variance_(variance),
      tile_(tile),
      differences_(padded * padded),
      across_(WeightTile::side * padded),
      distances_(WeightTile::side * WeightTile::side) {}

void PatchDistances::compare_pixels(int dx, int dy) {
    for (int row = 0; row < tile_.height + 2 * patch_radius; ++row) {
        const int y = tile_.y + row - patch_radius;
        const int x = tile_.x - patch_radius;
        const RgbRows p1(halves_[0], x, y);
        const RgbRows q1(halves_[0], x + dx, y + dy);
        const RgbRows p2(halves_[1], x, y);
        const RgbRows q2(halves_[1], x + dx, y + dy);
        const float* const variance_p = variance_.row(y) + x;
        const float* const variance_q = variance_.row(y + dy) + x + dx;
        float* const out = differences_.data() + row * padded;
        for (int i = 0; i < tile_.width + 2 * patch_radius; ++i) {
            const float product = (p1.c[0][i] - q1.c[0][i]) * (p2.c[0][i] - q2.c[0][i]) +
                                  (p1.c[1][i] - q1.c[1][i]) * (p2.c[1][i] - q2.c[1][i]) +
                                  (p1.c[2][i] - q1.c[2][i]) * (p2.c[2][i] - q2.c[2][i]);
            out[i] = product / (variance_p[i] + variance_q[i]);
        }
    }
}

void PatchDistances::compute(int dx, int dy) {
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

TileWeights::TileWeights(const FilterGuides& guides, const WeightTile& tile)
    : guides_(guides),
      tile_(tile),
      colors_(guides.halves, guides.variance, tile),
      features_(WeightTile::side * WeightTile::side) {
    for (std::vector<float>& weights : weights_)
        weights.resize(WeightTile::side * WeightTile::side);
}

void TileWeights::compute(int dx, int dy) {
    // Where colours are compared, too, features may differ more.
    constexpr float feature_weight = 0.5f;
    colors_.compute(dx, dy);
    compare_features(dx, dy);
    for (int row = 0; row < tile_.height; ++row) {
        const float* const color = colors_.row(row);
        const float* const feature = features_.data() + row * WeightTile::side;
        const float* const share = guides_.share.row(tile_.y + row + dy) + tile_.x + dx;
        float* const detail_out = weights_[detail].data() + row * WeightTile::side;
        float* const smooth_out = weights_[smooth].data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i) {
            smooth_out[i] = share[i] * falloff(feature[i]);
            detail_out[i] = share[i] * falloff(std::max(color[i], feature_weight * feature[i]));
        }
    }
}

void TileWeights::compare_features(int dx, int dy) {
    constexpr float different_depth = 0.02f;  // off the plane, of the sum of both nearnesses
    constexpr float depth_scale = 1.0f / (different_depth * different_depth);
    const auto step_x = static_cast<float>(dx);
    const auto step_y = static_cast<float>(dy);
    for (int row = 0; row < tile_.height; ++row) {
        const int y = tile_.y + row;
        const int x = tile_.x;
        const RgbRows normal_p(guides_.normal, x, y);
        const RgbRows normal_q(guides_.normal, x + dx, y + dy);
        const RgbRows albedo_p(guides_.albedo, x, y);
        const RgbRows albedo_q(guides_.albedo, x + dx, y + dy);
        const float* const noise_p = guides_.feature_variance.row(y) + x;
        const float* const noise_q = guides_.feature_variance.row(y + dy) + x + dx;
        const float* const near_p = guides_.nearness.row(y) + x;
        const float* const near_q = guides_.nearness.row(y + dy) + x + dx;
        const float* const slope_x = guides_.slope_x.row(y) + x;
        const float* const slope_y = guides_.slope_y.row(y) + x;
        float* const out = features_.data() + row * WeightTile::side;
        for (int i = 0; i < tile_.width; ++i) {
            float sum = 0;
            for (int c = 0; c < 3; ++c) {
                const float turned = normal_p.c[c][i] - normal_q.c[c][i];
                const float painted = albedo_p.c[c][i] - albedo_q.c[c][i];
                sum += turned * turned + painted * painted;
            }
            const float off_plane =
                near_q[i] - near_p[i] - slope_x[i] * step_x - slope_y[i] * step_y;
            const float near = near_p[i] + near_q[i] + 1e-10f;
            out[i] = sum / (1.0f + noise_p[i] + noise_q[i]) +
                     depth_scale * (off_plane * off_plane) / (near * near);
        }
    }
}

}  // namespace obscura
