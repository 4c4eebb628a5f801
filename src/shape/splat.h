// shape/splat.h - Gaussian splats: how much of a ray one of them takes, and blocks of sixteen.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/roots.h"

namespace obscura {

/// Splats in a block. Blocks are columns: 16 x, y and z of the mean, nine times 16 numbers of
/// ball_from_world row by row, 16 opacities; rows that are not there have opacity 0.
inline constexpr int splat_block = 16;
inline constexpr int splat_columns = 13;
inline constexpr int splat_block_floats = splat_columns * splat_block;

/// A splat ends so many standard deviations from its mean, as KHR_gaussian_splatting asks of its
/// kernel "ellipse", or where it takes less than this of the light: the rasteriser that splats are
/// trained with does not draw less.
/// Source  Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", TOG 42(4),
///         2023, appendix C
inline constexpr float splat_reach = 3.0f;
inline constexpr float least_splat_alpha = 1.0f / 255.0f;

inline namespace OBSCURA_ISA {

/// A Gaussian of greatest value `opacity`. The rows make a unit Gaussian around the origin of it.
template <typename F>
struct Splat {
    Vec3<F> mean;
    Vec3<F> ball_from_world[3];
    F opacity;
};

/// Where a ray's line passes a splat, and what share of the light behind it takes there; 0 where
/// the line passes beyond its end.
template <typename F>
struct SplatPassage {
    F t, alpha;
};

/// The place of greatest response.
///
/// Source  Moenne-Loccoz et al., "3D Gaussian Ray Tracing", TOG 43(6), 2024, section 4.2
template <typename F>
OBSCURA_INLINE SplatPassage<F> pass_splat(const Splat<F>& splat, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, splat.mean);
    const auto into_ball = [&](const Vec3<F>& v) {
        return Vec3<F>{dot(splat.ball_from_world[0], v),
                       dot(splat.ball_from_world[1], v),
                       dot(splat.ball_from_world[2], v)};
    };
    const Vec3<F> origin = into_ball(near.origin);
    const Vec3<F> direction = into_ball(near.direction);
    const F step = -dot(origin, direction) / dot(direction, direction);
    const Vec3<F> nearest = origin + direction * step;
    const F squared = dot(nearest, nearest);
    const F alpha = splat.opacity * exp(squared * F(-0.5f));
    const auto is_met = (squared <= F(splat_reach * splat_reach)) & (alpha >= F(least_splat_alpha));
    return {near.t + step, select(is_met, alpha, F(0.0f))};
}

/// Splats [first, first + lane_count) of a block.
OBSCURA_INLINE Splat<Lanes> read_splats(const float* block, int first) {
    const auto column = [&](int number) { return load(block + number * splat_block + first); };
    Splat<Lanes> out;
    out.mean = {column(0), column(1), column(2)};
    for (int r = 0; r < 3; ++r)
        out.ball_from_world[r] = {column(3 + 3 * r), column(4 + 3 * r), column(5 + 3 * r)};
    out.opacity = column(12);
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
