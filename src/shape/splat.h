// shape/splat.h - Gaussian splats: the opacity that a ray meets, and blocks of sixteen.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/roots.h"

namespace obscura {

/// Splats in a block. Blocks are columns: 16 x, y and z of the mean, nine times 16 numbers of
/// ball_from_world row by row, 16 opacities; unused entries have opacity 0.
inline constexpr int splat_block = 16;
inline constexpr int splat_columns = 13;
inline constexpr int splat_block_floats = splat_columns * splat_block;

/// A splat ends this many standard deviations from its mean, as KHR_gaussian_splatting requires of
/// its kernel "ellipse", or where its alpha falls below this minimum: the rasteriser that trains
/// splats skips less.
/// Source  Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", TOG 42(4),
///         2023, appendix C
inline constexpr float splat_reach = 3.0f;
inline constexpr float min_splat_alpha = 1.0f / 255.0f;

inline namespace OBSCURA_ISA {

/// A Gaussian with the maximum `opacity`. The matrix maps it to a unit Gaussian around the origin.
template <typename F>
struct Splat {
    Vec3<F> mean;
    Vec3<F> ball_from_world[3];
    F opacity;
};

/// The position at which a ray's line passes a splat, and the alpha there; 0 past the splat's end.
template <typename F>
struct SplatPassage {
    F t, alpha;
};

/// Evaluates the splat at the point of maximum response.
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
    const auto is_met = (squared <= F(splat_reach * splat_reach)) & (alpha >= F(min_splat_alpha));
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
