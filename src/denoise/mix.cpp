// denoise/mix.cpp - which filtered image is best at each pixel.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/mix.h"

#include "denoise/features.h"

#include <algorithm>

namespace obscura {

namespace {

/// The last error is that of the image as it is.
constexpr size_t unfiltered = candidate_count;
using Errors = std::array<Plane, candidate_count + 1>;

/// A plane of the same size.
template <typename Value>
Plane like(const Plane& plane, const Value& value) {
    return make_plane(plane.width(), plane.height(), plane.border(), value);
}

/// Makes errors at bright and dark pixels comparable: 1 / the squared brightness. It is that of a
/// pixel itself: beside a bright spot, filtered colours would tell a dark pixel to be bright.
Plane error_scale(const Plane& brightness_root) {
    const Plane& root = brightness_root;
    return like(root, [&](int x, int y) {
        const float square = root.row(y)[x] * root.row(y)[x];
        const float brightness = square * square;
        return 1.0f / (brightness * brightness + 1e-4f);
    });
}

/// In   cancelled: by how much the halves tell the error of their mean too large, scaled
Plane filter_error(const FilterGuides& guides,
                   const FilteredHalves& filtered,
                   const Plane& scale,
                   const Plane& cancelled) {
    return like(scale, [&](int x, int y) {
        float sum = 0;
        for (size_t c = 0; c < 3; ++c) {
            const float first = filtered.halves[0][c].row(y)[x];
            const float second = filtered.halves[1][c].row(y)[x];
            const float changes =
                (first - guides.halves[0][c].row(y)[x]) * (second - guides.halves[1][c].row(y)[x]);
            sum += changes + 0.25f * (first - second) * (first - second);
        }
        return sum * scale.row(y)[x] + cancelled.row(y)[x];
    });
}

/// Errors as each pixel alone tells them: far too noisy.
Errors errors_of_pixels(const FilterGuides& guides, const Candidates& candidates) {
    const Plane scale = error_scale(candidates[detail].brightness_root);
    const Plane variance = halves_variance(guides.halves[0], guides.halves[1]);
    // Samples are stratified over the pixel: where edges and textures make the noise, most of the
    // halves' errors cancel in their mean. The product of what a filter changes in either half,
    // whose errors have opposite signs there, tells as much too little.
    constexpr float cancels = 0.75f;
    const Plane cancelled = like(scale, [&](int x, int y) {
        return cancels * guides.aliasing.row(y)[x] * variance.row(y)[x] * scale.row(y)[x];
    });
    Errors out;
    for (size_t k = 0; k < candidate_count; ++k)
        out[k] = filter_error(guides, candidates[k], scale, cancelled);
    out[unfiltered] = like(scale, [&](int x, int y) {
        return variance.row(y)[x] * scale.row(y)[x] - cancelled.row(y)[x];
    });
    return out;
}

/// Means over the nearest pixels, which are few: what they tell is noisy, but of this place.
Errors near_errors(const Errors& errors) {
    constexpr int radius = 2;
    Errors out;
    for (size_t k = 0; k < errors.size(); ++k)
        out[k] = box_blur(box_blur(errors[k], radius), radius);
    return out;
}

/// Means over pixels of the window that have the same features, for a tile.
void filter_by_features(const FilterGuides& guides,
                        const Errors& errors,
                        const WeightTile& tile,
                        Errors& sums) {
    constexpr int step = 2;  // errors are blurred over 3 pixels
    FeatureDistances features(guides, guides, tile);
    std::vector<float> weight(static_cast<size_t>(WeightTile::side * WeightTile::side));
    std::vector<float> total(weight.size());
    for (int dy = -window_radius; dy <= window_radius; dy += step) {
        for (int dx = -window_radius; dx <= window_radius; dx += step) {
            features.compute(dx, dy);
            features.weigh(dx, dy, weight);
            add_weights(tile, weight.data(), total.data());
            for (size_t k = 0; k < errors.size(); ++k) {
                add_weighted(tile,
                             weight.data(),
                             rows_of(errors[k], tile.x + dx, tile.y + dy),
                             rows_of(sums[k], tile.x, tile.y));
            }
        }
    }
    for (int row = 0; row < tile.height; ++row) {
        for (int i = 0; i < tile.width; ++i) {
            const float all =
                total[static_cast<size_t>(row) * WeightTile::side + static_cast<size_t>(i)];
            for (Plane& sum : sums) {
                float& value = sum.row(tile.y + row)[tile.x + i];
                value = all > 0 ? value / all : 0.0f;
            }
        }
    }
}

/// Means over pixels of the same features, which are many: what they tell is less noisy.
Errors feature_weighted_errors(const FilterGuides& guides, const Errors& errors) {
    const Plane& size = guides.variance;
    Errors blurred;
    for (size_t k = 0; k < errors.size(); ++k)
        blurred[k] = box_blur(errors[k], 1);
    Errors out;
    out.fill(Plane(size.width(), size.height(), size.border()));
    const std::vector<WeightTile> tiles = weight_tiles(size.width(), size.height());
    parallel_for(tiles.size(),
                 [&](size_t i) { filter_by_features(guides, blurred, tiles[i], out); });
    for (Plane& error : out) {
        error.extend();
        error = box_blur(error, 1);
    }
    return out;
}

}  // namespace

Mix mix_candidates(const FilterGuides& guides, const Candidates& candidates) {
    const Errors single = errors_of_pixels(guides, candidates);
    const Errors near = near_errors(single);
    const Errors alike = feature_weighted_errors(guides, single);
    const Plane& size = guides.variance;
    Mix mix;
    mix.noisy = Plane(size.width(), size.height(), size.border());
    mix.filtered.fill(mix.noisy);
    // Weights have seen the noise that they filter: the estimates of filters are a little too low.
    constexpr float caution = 0.8f;
    // How much of an error that the nearest pixels alone tell is not chance.
    constexpr float trust = 0.5f;
    for_rows(size.height(), [&](int y) {
        for (int x = 0; x < size.width(); ++x) {
            const auto relative = [&](const Errors& errors, size_t k) {
                const float noise = errors[unfiltered].row(y)[x];
                return noise > 0 ? errors[k].row(y)[x] / noise : 0.0f;
            };
            if (caution * alike[unfiltered].row(y)[x] <= 1e-12f) {
                mix.noisy.row(y)[x] = 1.0f;
                continue;
            }
            // Shares go by the inverse square of the errors; none is taken to be nothing.
            float total = 1.0f;
            std::array<float, candidate_count> shares = {};
            for (size_t k = 0; k < candidate_count; ++k) {
                const float error = std::max(relative(alike, k), trust * relative(near, k));
                const float ratio = std::max(error / caution, 1e-4f);
                shares[k] = 1 / (ratio * ratio);
                total += shares[k];
            }
            for (size_t k = 0; k < candidate_count; ++k)
                mix.filtered[k].row(y)[x] = shares[k] / total;
            mix.noisy.row(y)[x] = 1.0f / total;
        }
    });
    return mix;
}

}  // namespace obscura
