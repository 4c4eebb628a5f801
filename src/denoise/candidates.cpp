// denoise/candidates.cpp - filtered images, to be mixed.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/candidates.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr int side = WeightTile::side;

/// Calls `body(frame, weights, dx, dy)` for every neighbour in every frame with its weights, the
/// pixel itself among them. Of other frames fewer count: what is moved there is not quite the same.
template <typename Body>
void for_neighbors(std::span<const Frame> frames, const WeightTile& tile, const Body& body) {
    for (const Frame& frame : frames) {
        const int radius = &frame == &frames[0] ? window_radius : window_radius / 2;
        TileWeights weights(frames[0].guides, frame.guides, tile);
        for (int dy = -radius; dy <= radius; ++dy) {
            for (int dx = -radius; dx <= radius; ++dx) {
                weights.compute(dx, dy);
                body(frame, weights, dx, dy);
            }
        }
    }
}

/// What is filtered: both halves, and the roots of brightness.
constexpr size_t plane_count = 7;

template <typename Filtered>
auto planes_of(Filtered& from) {
    using OnePlane = decltype(&from.brightness_root);
    std::array<OnePlane, plane_count> out;
    for (size_t k = 0; k < 6; ++k)
        out[k] = &from.halves[k / 3][k % 3];
    out[6] = &from.brightness_root;
    return out;
}

void filter_tile(std::span<const Frame> frames, const WeightTile& tile, Candidates& out) {
    constexpr size_t area = side * side;
    constexpr size_t areas = (1 + plane_count) * area;  // the weights come first
    std::vector<float> sums(candidate_count * areas);
    for_neighbors(
        frames, tile, [&](const Frame& frame, const TileWeights& weights, int dx, int dy) {
            const auto planes = planes_of(frame.guides);
            for (size_t candidate = 0; candidate < candidate_count; ++candidate) {
                const float* const weight = weights.of(candidate);
                float* sum = sums.data() + candidate * areas;
                add_weights(tile, weight, sum);
                for (const Plane* const plane : planes) {
                    sum += area;
                    const auto values = rows_of(*plane, tile.x + dx, tile.y + dy);
                    add_weighted(tile, weight, values, {sum, side});
                }
            }
        });
    for (size_t candidate = 0; candidate < candidate_count; ++candidate) {
        FilteredHalves& to = out[candidate];
        const auto planes = planes_of(to);
        for (int row = 0; row < tile.height; ++row) {
            const float* const weight =
                sums.data() + candidate * areas + static_cast<size_t>(row * side);
            std::copy_n(weight, tile.width, to.weight.row(tile.y + row) + tile.x);
            for (size_t k = 0; k < plane_count; ++k) {
                float* const value = planes[k]->row(tile.y + row) + tile.x;
                const float* const sum = weight + (k + 1) * area;
                for (int i = 0; i < tile.width; ++i)
                    value[i] = weight[i] > 0 ? sum[i] / weight[i] : 0.0f;
            }
        }
    }
}

/// Filters all layers in one tile; what `mix.noisy` says of them stays as it is.
void filter_layers_tile(std::span<const Frame> frames,
                        const WeightTile& tile,
                        const std::array<Plane, candidate_count>& factors,
                        std::vector<Rgb>& out) {
    std::vector<float> all(static_cast<size_t>(side * side));
    for_neighbors(
        frames, tile, [&](const Frame& frame, const TileWeights& weights, int dx, int dy) {
            std::fill(all.begin(), all.end(), 0.0f);
            for (size_t k = 0; k < candidate_count; ++k) {
                const auto factor = rows_of(factors[k], tile.x, tile.y);
                add_weighted(tile, weights.of(k), factor, {all.data(), side});
            }
            for (size_t layer = 0; layer < out.size(); ++layer) {
                for (size_t c = 0; c < 3; ++c) {
                    const Plane& from = frame.layers[layer][c];
                    add_weighted(tile,
                                 all.data(),
                                 rows_of(from, tile.x + dx, tile.y + dy),
                                 rows_of(out[layer][c], tile.x, tile.y));
                }
            }
        });
}

}  // namespace

Candidates filter_halves(std::span<const Frame> frames) {
    const Plane& size = frames[0].guides.variance;
    Candidates out;
    for (FilteredHalves& one : out) {
        one.weight = one.brightness_root = Plane(size.width(), size.height(), size.border());
        for (Rgb& half : one.halves)
            half.fill(one.weight);
    }
    const std::vector<WeightTile> tiles = weight_tiles(size.width(), size.height());
    parallel_for(tiles.size(), [&](size_t i) { filter_tile(frames, tiles[i], out); });
    return out;
}

Rgb mixed_halves(const FilterGuides& guides,
                 const Candidates& candidates,
                 const Mix& mix,
                 float first_share) {
    const Plane& size = guides.variance;
    Rgb out;
    for (size_t c = 0; c < 3; ++c) {
        const auto mean = [&](const Rgb* halves, int x, int y) {
            return first_share * halves[0][c].row(y)[x] +
                   (1 - first_share) * halves[1][c].row(y)[x];
        };
        out[c] = make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
            float sum = mix.noisy.row(y)[x] * mean(guides.halves, x, y);
            for (size_t k = 0; k < candidate_count; ++k)
                sum += mix.filtered[k].row(y)[x] * mean(candidates[k].halves, x, y);
            return sum;
        });
    }
    return out;
}

std::vector<Rgb> filter_layers(std::span<const Frame> frames,
                               const Candidates& candidates,
                               const Mix& mix) {
    const std::vector<Rgb>& layers = frames[0].layers;
    const Plane& size = frames[0].guides.variance;
    std::array<Plane, candidate_count> factors;
    for (size_t k = 0; k < candidate_count; ++k) {
        factors[k] = make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
            const float weight = candidates[k].weight.row(y)[x];
            return weight > 0 ? mix.filtered[k].row(y)[x] / weight : 0.0f;
        });
    }
    std::vector<Rgb> out(layers.size());
    for (size_t layer = 0; layer < layers.size(); ++layer) {
        for (size_t c = 0; c < 3; ++c) {
            out[layer][c] =
                make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
                    return mix.noisy.row(y)[x] * layers[layer][c].row(y)[x];
                });
        }
    }
    const std::vector<WeightTile> tiles = weight_tiles(size.width(), size.height());
    parallel_for(tiles.size(),
                 [&](size_t i) { filter_layers_tile(frames, tiles[i], factors, out); });
    return out;
}

}  // namespace obscura
