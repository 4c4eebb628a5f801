// denoise/aliasing.cpp - how much of the noise comes from edges and textures inside pixels.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/aliasing.h"

#include <algorithm>
#include <array>
#include <vector>

namespace obscura {

namespace {

constexpr int regression_radius = 1;
/// Sums of squares of differences over a square of pixels that are far smaller explain nothing:
/// normals of curved surfaces turn by as much in a pixel, and albedo is rounded.
constexpr float normal_noise_floor = 1e-3f;
constexpr float albedo_noise_floor = 1e-8f;

Plane difference(const Plane& first, const Plane& second) {
    return make_plane(first.width(), first.height(), first.border(), [&](int x, int y) {
        return first.row(y)[x] - second.row(y)[x];
    });
}

Rgb difference(const Rgb* halves) {
    Rgb out;
    for (size_t c = 0; c < 3; ++c)
        out[c] = difference(halves[0][c], halves[1][c]);
    return out;
}

/// Sums of products of two planes over the squares around the pixels of a row.
void add_products(const Plane& a, const Plane& b, int y, std::vector<float>& sums) {
    std::fill(sums.begin(), sums.end(), 0.0f);
    for (int dy = -regression_radius; dy <= regression_radius; ++dy) {
        for (int dx = -regression_radius; dx <= regression_radius; ++dx) {
            const float* const from = a.row(y + dy) + dx;
            const float* const with = b.row(y + dy) + dx;
            for (size_t x = 0; x < sums.size(); ++x)
                sums[x] += from[x] * with[x];
        }
    }
}

/// What one row adds up to, by pixel.
struct RowSums {
    explicit RowSums(size_t width)
        : all(width), explained(width), square(width), together(width), best(width) {
        feature_squares.fill(std::vector<float>(width));
    }

    std::vector<float> all, explained;  ///< squares of the colours' differences
    std::vector<float> square, together, best;
    std::array<std::vector<float>, 6> feature_squares;
};

/// In   features: first those of the albedo, of which each goes with its own colour alone
void explain_row(const Rgb& colors, const std::array<Rgb, 2>& features, int y, RowSums& sums) {
    for (size_t k = 0; k < 6; ++k) {
        const Plane& feature = features[k / 3][k % 3];
        add_products(feature, feature, y, sums.feature_squares[k]);
    }
    for (size_t c = 0; c < 3; ++c) {
        add_products(colors[c], colors[c], y, sums.square);
        std::fill(sums.best.begin(), sums.best.end(), 0.0f);
        for (const size_t k : {c, size_t{3}, size_t{4}, size_t{5}}) {
            const float too_small = k < 3 ? albedo_noise_floor : normal_noise_floor;
            add_products(colors[c], features[k / 3][k % 3], y, sums.together);
            for (size_t x = 0; x < sums.best.size(); ++x) {
                const float both = sums.together[x];
                const float explained = both * both / (sums.feature_squares[k][x] + too_small);
                sums.best[x] = std::max(sums.best[x], explained);
            }
        }
        for (size_t x = 0; x < sums.best.size(); ++x) {
            sums.all[x] += sums.square[x];
            sums.explained[x] += sums.best[x];
        }
    }
}

}  // namespace

Plane aliasing_share(const Rgb* colors, const Rgb* albedo, const Rgb* normal) {
    const Rgb color = difference(colors);
    const std::array<Rgb, 2> features = {difference(albedo), difference(normal)};
    Plane out(color[0].width(), color[0].height(), color[0].border());
    for_rows(out.height(), [&](int y) {
        const auto width = static_cast<size_t>(out.width());
        RowSums sums(width);
        explain_row(color, features, y, sums);
        float* const row = out.row(y);
        for (size_t x = 0; x < width; ++x) {
            const float all = sums.all[x];
            row[x] = all > 0 ? std::min(1.0f, sums.explained[x] / all) : 0.0f;
        }
    });
    out.extend();
    return out;
}

}  // namespace obscura
