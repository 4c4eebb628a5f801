// denoise/candidates.cpp - filtered images, and which of them is best at each pixel.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/candidates.h"

#include "denoise/features.h"

#include <cmath>

namespace obscura {

namespace {

constexpr int side = WeightTile::side;

/// Calls `body(dx, dy)` for every neighbour, the pixel itself among them.
template <typename Body>
void for_window(const Body& body) {
    for (int dy = -window_radius; dy <= window_radius; ++dy) {
        for (int dx = -window_radius; dx <= window_radius; ++dx)
            body(dx, dy);
    }
}

void add_weighted(const float* weights, const float* values, int count, float* sums) {
    for (int i = 0; i < count; ++i)
        sums[i] += weights[i] * values[i];
}

void filter_tile(const FilterGuides& guides, const WeightTile& tile, Candidates& out) {
    constexpr size_t area = side * side;
    TileWeights weights(guides, tile);
    std::vector<float> sums(candidate_count * 7 * area);
    for_window([&](int dx, int dy) {
        weights.compute(dx, dy);
        for (size_t candidate = 0; candidate < candidate_count; ++candidate) {
            for (int row = 0; row < tile.height; ++row) {
                const float* const weight = weights.row(static_cast<Candidate>(candidate), row);
                float* sum = sums.data() + candidate * 7 * area + static_cast<size_t>(row * side);
                for (int i = 0; i < tile.width; ++i)
                    sum[i] += weight[i];
                for (size_t k = 0; k < 6; ++k) {
                    sum += area;
                    const Plane& from = guides.halves[k / 3][k % 3];
                    add_weighted(
                        weight, from.row(tile.y + row + dy) + tile.x + dx, tile.width, sum);
                }
            }
        }
    });
    for (size_t candidate = 0; candidate < candidate_count; ++candidate) {
        FilteredHalves& to = out[candidate];
        for (int row = 0; row < tile.height; ++row) {
            const float* const weight =
                sums.data() + candidate * 7 * area + static_cast<size_t>(row * side);
            std::copy_n(weight, tile.width, to.weight.row(tile.y + row) + tile.x);
            for (size_t k = 0; k < 6; ++k) {
                float* const value = to.halves[k / 3][k % 3].row(tile.y + row) + tile.x;
                const float* const sum = weight + (k + 1) * area;
                for (int i = 0; i < tile.width; ++i)
                    value[i] = weight[i] > 0 ? sum[i] / weight[i] : 0.0f;
            }
        }
    }
}

/// Filters all images in one tile; what `mix.noisy` says of them stays as it is.
void filter_images_tile(const FilterGuides& guides,
                        const WeightTile& tile,
                        const std::array<Plane, candidate_count>& factors,
                        std::span<const Rgb> images,
                        std::vector<Rgb>& out) {
    TileWeights weights(guides, tile);
    std::vector<float> weight(side);
    for_window([&](int dx, int dy) {
        weights.compute(dx, dy);
        for (int row = 0; row < tile.height; ++row) {
            const int y = tile.y + row;
            std::fill(weight.begin(), weight.end(), 0.0f);
            for (size_t k = 0; k < candidate_count; ++k) {
                add_weighted(weights.row(static_cast<Candidate>(k), row),
                             factors[k].row(y) + tile.x,
                             tile.width,
                             weight.data());
            }
            for (size_t image = 0; image < images.size(); ++image) {
                for (size_t c = 0; c < 3; ++c) {
                    add_weighted(weight.data(),
                                 images[image][c].row(y + dy) + tile.x + dx,
                                 tile.width,
                                 out[image][c].row(y) + tile.x);
                }
            }
        }
    });
}

/// Makes errors at bright and dark pixels comparable: 1 / the squared brightness.
Plane error_scale(const FilteredHalves& from) {
    const Plane& size = from.weight;
    return make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
        float sum = 0;
        for (const Rgb& half : from.halves) {
            for (const Plane& channel : half)
                sum += channel.row(y)[x];
        }
        sum *= 1.0f / 6.0f;
        return 1.0f / (sum * sum + 1e-4f);
    });
}

Plane smoothed(const Plane& error) {
    constexpr int radius = 2;
    return box_blur(box_blur(error, radius), radius);
}

Plane filter_error(const FilterGuides& guides, const FilteredHalves& filtered, const Plane& scale) {
    const Plane error =
        make_plane(scale.width(), scale.height(), scale.border(), [&](int x, int y) {
            float sum = 0;
            for (size_t c = 0; c < 3; ++c) {
                const float first = filtered.halves[0][c].row(y)[x];
                const float second = filtered.halves[1][c].row(y)[x];
                const float changes = (first - guides.halves[0][c].row(y)[x]) *
                                      (second - guides.halves[1][c].row(y)[x]);
                sum += changes + 0.25f * (first - second) * (first - second);
            }
            return sum * scale.row(y)[x];
        });
    return smoothed(error);
}

}  // namespace

Candidates filter_halves(const FilterGuides& guides) {
    const Plane& size = guides.variance;
    Candidates out;
    for (FilteredHalves& one : out) {
        one.weight = Plane(size.width(), size.height(), size.border());
        for (Rgb& half : one.halves)
            half.fill(one.weight);
    }
    const std::vector<WeightTile> tiles = weight_tiles(size.width(), size.height());
    parallel_for(tiles.size(), [&](size_t i) { filter_tile(guides, tiles[i], out); });
    return out;
}

Mix mix_candidates(const FilterGuides& guides, const Candidates& candidates) {
    const Plane scale = error_scale(candidates[detail]);
    const int width = scale.width();
    const int height = scale.height();
    std::array<Plane, candidate_count> errors;
    for (size_t k = 0; k < candidate_count; ++k)
        errors[k] = filter_error(guides, candidates[k], scale);
    const Plane variance = halves_variance(guides.halves[0], guides.halves[1]);
    const Plane noise = smoothed(make_plane(width, height, scale.border(), [&](int x, int y) {
        return variance.row(y)[x] * scale.row(y)[x];
    }));
    Mix mix;
    mix.noisy = Plane(width, height, scale.border());
    mix.filtered.fill(mix.noisy);
    // Weights have seen the noise that they filter: the estimates of filters are a little too low.
    constexpr float caution = 0.8f;
    for_rows(height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const float unfiltered = caution * noise.row(y)[x];
            if (unfiltered <= 1e-12f) {
                mix.noisy.row(y)[x] = 1.0f;
                continue;
            }
            // Shares go by the inverse square of the errors; none is taken to be nothing.
            float total = 1.0f;
            std::array<float, candidate_count> shares = {};
            for (size_t k = 0; k < candidate_count; ++k) {
                const float error = std::max(errors[k].row(y)[x], 1e-4f * unfiltered);
                shares[k] = unfiltered * unfiltered / (error * error);
                total += shares[k];
            }
            for (size_t k = 0; k < candidate_count; ++k)
                mix.filtered[k].row(y)[x] = shares[k] / total;
            mix.noisy.row(y)[x] = 1.0f / total;
        }
    });
    return mix;
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

std::vector<Rgb> filter_images(const FilterGuides& guides,
                               const Candidates& candidates,
                               const Mix& mix,
                               std::span<const Rgb> images) {
    const Plane& size = guides.variance;
    std::array<Plane, candidate_count> factors;
    for (size_t k = 0; k < candidate_count; ++k) {
        factors[k] = make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
            const float weight = candidates[k].weight.row(y)[x];
            return weight > 0 ? mix.filtered[k].row(y)[x] / weight : 0.0f;
        });
    }
    std::vector<Rgb> out(images.size());
    for (size_t image = 0; image < images.size(); ++image) {
        for (size_t c = 0; c < 3; ++c) {
            out[image][c] =
                make_plane(size.width(), size.height(), size.border(), [&](int x, int y) {
                    return mix.noisy.row(y)[x] * images[image][c].row(y)[x];
                });
        }
    }
    const std::vector<WeightTile> tiles = weight_tiles(size.width(), size.height());
    parallel_for(tiles.size(),
                 [&](size_t i) { filter_images_tile(guides, tiles[i], factors, images, out); });
    return out;
}

}  // namespace obscura
