// denoise/features.cpp - albedo and normal without their own noise.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/features.h"

#include "denoise/weights.h"

namespace obscura {

namespace {

/// Neighbours on every side: edges have few that are like them, further away than this.
constexpr int feature_radius = 3;

/// Filters both halves in one tile.
void clean_tile(const Rgb* halves, const Plane& variance, const WeightTile& tile, Rgb* out) {
    constexpr int side = WeightTile::side;
    const NoisyHalves noisy{halves, variance};
    PatchDistances distances(noisy, noisy, tile);
    constexpr size_t area = size_t{side} * side;
    std::vector<float> weights(area), sums(7 * area);
    for (int dy = -feature_radius; dy <= feature_radius; ++dy) {
        for (int dx = -feature_radius; dx <= feature_radius; ++dx) {
            distances.compute(dx, dy);
            distances.weigh(weights);
            add_weights(tile, weights.data(), sums.data());
            for (size_t k = 0; k < 6; ++k) {
                const Plane& from = halves[k / 3][k % 3];
                add_weighted(tile,
                             weights.data(),
                             rows_of(from, tile.x + dx, tile.y + dy),
                             {sums.data() + (k + 1) * area, side});
            }
        }
    }
    for (size_t k = 0; k < 6; ++k) {
        for (int row = 0; row < tile.height; ++row) {
            const float* const weight = sums.data() + row * side;
            const float* const sum = weight + (k + 1) * area;
            float* const to = out[k / 3][k % 3].row(tile.y + row) + tile.x;
            for (int i = 0; i < tile.width; ++i)
                to[i] = sum[i] / weight[i];
        }
    }
}

}  // namespace

Plane halves_variance(const Rgb& first, const Rgb& second) {
    const Plane& size = first[0];
    return make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
        float sum = 0;
        for (size_t c = 0; c < 3; ++c) {
            const float difference = first[c].row(y)[x] - second[c].row(y)[x];
            sum += 0.25f * difference * difference;
        }
        return sum;
    });
}

CleanFeature clean_feature(const Rgb* halves) {
    const int width = halves[0][0].width();
    const int height = halves[0][0].height();
    const Plane smooth = box_blur(halves_variance(halves[0], halves[1]), 1);
    // Differences below a thousandth count as noise.
    const Plane variance = make_plane(
        width, height, plane_border, [&](int x, int y) { return smooth.row(y)[x] + 1e-6f; });
    Rgb filtered[2];
    for (Rgb& half : filtered) {
        for (Plane& plane : half)
            plane = Plane(width, height, plane_border);
    }
    const std::vector<WeightTile> tiles = weight_tiles(width, height);
    parallel_for(tiles.size(), [&](size_t i) { clean_tile(halves, variance, tiles[i], filtered); });
    CleanFeature out;
    out.variance = box_blur(halves_variance(filtered[0], filtered[1]), 1);
    for (size_t c = 0; c < 3; ++c) {
        out.mean[c] = make_plane(width, height, plane_border, [&](int x, int y) {
            return 0.5f * (filtered[0][c].row(y)[x] + filtered[1][c].row(y)[x]);
        });
    }
    return out;
}

}  // namespace obscura
