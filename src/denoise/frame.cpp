// denoise/frame.cpp - an image as the filter looks at it.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/frame.h"

#include "denoise/aliasing.h"
#include "denoise/features.h"
#include "denoise/outliers.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// Features this far apart are different: a weight of 1 / e.
constexpr float different_normal = 0.12f;
constexpr float different_albedo = 0.1f;
/// Colours are divided by no less: what dark surfaces show is light that they mirror or emit.
constexpr float darkest_albedo = 0.2f;
/// Of the square that the variance is a mean over; one pixel's has one degree of freedom.
constexpr int variance_radius = 3;

/// Of two slopes the gentler one: at an edge that is the one on the pixel's own side.
float gentler(float before, float after) {
    if (before * after <= 0) return 0;
    return std::abs(before) < std::abs(after) ? before : after;
}

void add_depth(std::span<const float> depth, const PlaneSize& size, FilterGuides& guides) {
    guides.nearness = size.plane([&](int x, int y) {
        const float z = depth[size.index(x, y)];
        return z > 0 ? 1 / z : 0.0f;
    });
    const Plane& near = guides.nearness;
    guides.slope_x = size.plane([&](int x, int y) {
        const float* const row = near.row(y) + x;
        return gentler(row[0] - row[-1], row[1] - row[0]);
    });
    guides.slope_y = size.plane([&](int x, int y) {
        const float at = near.row(y)[x];
        return gentler(at - near.row(y - 1)[x], near.row(y + 1)[x] - at);
    });
}

Rgb scaled(const Rgb& from, float factor, const PlaneSize& size) {
    Rgb out;
    for (size_t c = 0; c < 3; ++c)
        out[c] = size.plane([&](int x, int y) { return factor * from[c].row(y)[x]; });
    return out;
}

/// Whether squares of a pixel's colours may be no numbers any more: it stays as it is.
bool is_beyond_squares(const Halves& color, size_t pixel) {
    constexpr float largest = 1e15f;
    const auto is_large = [&](float value) { return !(std::abs(value) <= largest); };
    return std::any_of(color.begin(), color.end(), [&](std::span<const float> half) {
        const auto values = half.subspan(3 * pixel, 3);
        return std::any_of(values.begin(), values.end(), is_large);
    });
}

/// Adds the features; returns by what colours are divided.
Rgb add_features(const DenoiseInput& input, const PlaneSize& size, FilterGuides& guides) {
    const Rgb albedo_halves[2] = {size.rgb(input.albedo[0], 3), size.rgb(input.albedo[1], 3)};
    const Rgb normal_halves[2] = {size.rgb(input.normal[0], 3), size.rgb(input.normal[1], 3)};
    const CleanFeature albedo = clean_feature(albedo_halves);
    const CleanFeature normal = clean_feature(normal_halves);
    guides.albedo = scaled(albedo.mean, 1 / different_albedo, size);
    guides.normal = scaled(normal.mean, 1 / different_normal, size);
    guides.feature_variance = size.plane([&](int x, int y) {
        return albedo.variance.row(y)[x] / (different_albedo * different_albedo) +
               normal.variance.row(y)[x] / (different_normal * different_normal);
    });
    add_depth(input.depth, size, guides);
    guides.share = Plane(size.width, size.height, plane_border);
    for_rows(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            const size_t pixel = size.index(x, y);
            const float alpha = input.alpha.empty() ? 1.0f : input.alpha[pixel];
            const bool is_usable = !is_beyond_squares(input.color, pixel);
            guides.share.row(y)[x] = is_usable ? std::clamp(alpha, 0.0f, 1.0f) : 0.0f;
        }
    });
    Rgb out;
    for (size_t c = 0; c < 3; ++c) {
        out[c] = size.plane([&](int x, int y) {
            // What is seen beside surfaces is light as it is.
            const float beside = 1 - std::clamp(input.opacity[size.index(x, y)], 0.0f, 1.0f);
            const float reflected = albedo.mean[c].row(y)[x] + beside;
            return guides.share.row(y)[x] * std::max(reflected, darkest_albedo);
        });
    }
    return out;
}

/// Divides colours; 0 where the divisor is.
Rgb divided(const Rgb& from, const Rgb& by, const PlaneSize& size) {
    Rgb out;
    for (size_t c = 0; c < 3; ++c) {
        out[c] = size.plane([&](int x, int y) {
            const float divisor = by[c].row(y)[x];
            return divisor > 0 ? from[c].row(y)[x] / divisor : 0.0f;
        });
    }
    return out;
}

void add_variance(const PlaneSize& size, FilterGuides& guides) {
    const Plane smooth =
        box_blur(halves_variance(guides.halves[0], guides.halves[1]), variance_radius);
    guides.variance = size.plane([&](int x, int y) {
        float sum = 0;
        for (const Rgb& half : guides.halves) {
            for (const Plane& channel : half)
                sum += channel.row(y)[x];
        }
        return smooth.row(y)[x] + 1e-7f * sum * sum + 1e-12f;  // above 0, for it divides
    });
}

void add_brightness(const PlaneSize& size, FilterGuides& guides) {
    guides.brightness_root = size.plane([&](int x, int y) {
        float sum = 0;
        for (const Rgb& half : guides.halves) {
            for (const Plane& channel : half)
                sum += channel.row(y)[x];
        }
        return std::sqrt(std::sqrt(std::max(sum * (1.0f / 6.0f), 0.0f)));
    });
}

/// The share of a pixel's light that outliers leave, by channel: the same for every layer.
Rgb kept_shares(const Rgb* raw,
                const FilterGuides& guides,
                float first_share,
                const PlaneSize& size) {
    Rgb out;
    for (size_t c = 0; c < 3; ++c) {
        const auto mean = [&](const Rgb* halves, int x, int y) {
            return first_share * halves[0][c].row(y)[x] +
                   (1 - first_share) * halves[1][c].row(y)[x];
        };
        out[c] = size.plane([&](int x, int y) {
            const float all = mean(raw, x, y);
            return all > 0 ? mean(guides.halves, x, y) / all : 1.0f;
        });
    }
    return out;
}

}  // namespace

Rgb product(const Rgb& a, const Rgb& b) {
    const PlaneSize size{a[0].width(), a[0].height()};
    Rgb out;
    for (size_t c = 0; c < 3; ++c)
        out[c] = size.plane([&](int x, int y) { return a[c].row(y)[x] * b[c].row(y)[x]; });
    return out;
}

Plane aliasing_of(const DenoiseInput& input, const Frame& frame) {
    const PlaneSize size{input.width, input.height};
    Rgb albedo[2], normal[2];
    for (size_t half = 0; half < 2; ++half) {
        albedo[half] = divided(size.rgb(input.albedo[half], 3), frame.reflected, size);
        normal[half] = size.rgb(input.normal[half], 3);
    }
    return aliasing_share(frame.guides.halves, albedo, normal);
}

Frame make_frame(const DenoiseInput& input, std::span<const LightImage> layers) {
    const PlaneSize size{input.width, input.height};
    Frame out;
    FilterGuides& guides = out.guides;
    out.reflected = add_features(input, size, guides);
    Rgb raw[2];
    for (size_t half = 0; half < 2; ++half)
        raw[half] = divided(size.rgb(input.color[half], 3), out.reflected, size);
    const Outliers outliers = find_outliers(raw[0], raw[1]);
    out.outlier_share = outliers.share;
    for (size_t half = 0; half < 2; ++half) {
        const Plane& keep = outliers.keep[half];
        guides.halves[half] = product(raw[half], {keep, keep, keep});
    }
    add_variance(size, guides);
    add_brightness(size, guides);
    out.kept = kept_shares(raw, guides, input.first_share, size);
    for (const LightImage& layer : layers) {
        const Rgb light = divided(size.rgb(layer.pixels, layer.channels), out.reflected, size);
        out.layers.push_back(product(light, out.kept));
    }
    return out;
}

}  // namespace obscura
