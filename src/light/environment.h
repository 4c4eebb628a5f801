// light/environment.h - light from infinitely far away, all around: look-up, density and sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/cdf_table.h"
#include "math/sampler.h"
#include "math/vec.h"
#include "math/warp.h"

#include <type_traits>

namespace obscura {

/// What the lanes see of an EnvironmentTable (light/environment_table.h), which owns the arrays.
///
/// The map is latitude-longitude: u = atan2(z, x) / 2 pi + 0.5, v = acos(y) / pi; +Y is row 0.
struct EnvironmentView {
    /// 4 floats a pixel, so that one cache line holds what a look-up needs: the radiance, and the
    /// density per solid angle with which the pixel is sampled, times sin(theta)
    const float* pixels = nullptr;
    const CdfEntry* rows = nullptr;     ///< chooses a row
    const CdfEntry* columns = nullptr;  ///< height tables, one a row: chooses a pixel
    int32_t width = 1;
    int32_t height = 1;
    float cos_rotation = 1;  ///< of the angle by which the map is turned about +Y,
    float sin_rotation = 0;  ///< counter-clockwise seen from above
};

inline namespace OBSCURA_ISA {

template <typename F>
struct EnvironmentSample {
    Vec3<F> direction;  ///< world, unit
    Vec3<F> radiance;
    F pdf;  ///< 1/sr; 0 when the map is black
};

/// A direction's place on the map, in pixels, and the sine of its polar angle.
template <typename F>
struct EnvironmentPoint {
    F x, y;  ///< in [0, width], [0, height]
    F sin_theta;
};

/// A constant with all the digits that F has.
template <typename F>
OBSCURA_INLINE F exact_constant(double value) {
    if constexpr (std::is_same_v<F, double>) {
        return value;
    } else {
        return F(static_cast<float>(value));
    }
}

/// Finds a world direction on the map. The polar angle comes from an arc tangent: the arc cosine
/// would lose half the digits near the poles.
template <typename F>
OBSCURA_INLINE EnvironmentPoint<F> environment_point(const EnvironmentView& view,
                                                     const Vec3<F>& direction) {
    const F c(view.cos_rotation);
    const F s(view.sin_rotation);
    const F x = direction.x * c - direction.z * s;
    const F z = direction.x * s + direction.z * c;
    const F sin_theta = sqrt(x * x + z * z);
    const F azimuth = atan2(z, select(sin_theta > F(0.0f), x, F(1.0f)));
    const F polar = atan2(sin_theta, direction.y);
    return {(azimuth * exact_constant<F>(0.5 / pi_d) + F(0.5f)) * from_int<F>(IntOf<F>(view.width)),
            polar * exact_constant<F>(1.0 / pi_d) * from_int<F>(IntOf<F>(view.height)),
            sin_theta};
}

/// The pixel that a coordinate falls into; anything out of range, NaN too, goes to an end.
template <typename F>
OBSCURA_INLINE IntOf<F> environment_cell(const F& coordinate, int32_t size) {
    const F last = from_int<F>(IntOf<F>(size - 1));
    return to_int(clamp(coordinate, F(0.0f), last));
}

template <typename F>
OBSCURA_INLINE F environment_density(const EnvironmentView& view,
                                     const IntOf<F>& pixel,
                                     const F& sin_theta) {
    return gather<F>(view.pixels + 3, pixel * IntOf<F>(4)) / max(sin_theta, F(1e-7f));
}

/// Bilinear interpolation between pixel centres; wraps around in x, stops at the first and last
/// row.
template <typename F>
OBSCURA_INLINE Vec3<F> environment_pixel(const EnvironmentView& view, const F& x, const F& y) {
    using I = IntOf<F>;
    const F from_x = clamp(x - F(0.5f), F(-1.0f), from_int<F>(I(view.width - 1)) + F(0.5f));
    const F from_y = clamp(y - F(0.5f), F(0.0f), from_int<F>(I(view.height - 1)));
    const F floor_x = floor(from_x);
    const F floor_y = floor(from_y);
    const F right = from_x - floor_x;
    const F down = from_y - floor_y;
    const I column = to_int(floor_x);
    const I column0 = select(column < I(0), I(view.width - 1), column);
    const I column1 = select(column >= I(view.width - 1), I(0), column + I(1));
    const I row0 = to_int(floor_y);
    const I row1 = min(row0 + I(1), I(view.height - 1));

    Vec3<F> sum = splat3(F(0.0f));
    const auto add = [&](const I& row, const I& column_at, const F& weight) {
        const I word = (row * I(view.width) + column_at) * I(4);
        sum = sum + weight * Vec3<F>{gather<F>(view.pixels, word),
                                     gather<F>(view.pixels + 1, word),
                                     gather<F>(view.pixels + 2, word)};
    };
    const F left = F(1.0f) - right;
    const F up = F(1.0f) - down;
    add(row0, column0, left * up);
    add(row0, column1, right * up);
    add(row1, column0, left * down);
    add(row1, column1, right * down);
    return sum;
}

/// Radiance that arrives from a world direction (unit).
template <typename F>
OBSCURA_INLINE Vec3<F> environment_radiance(const EnvironmentView& view, const Vec3<F>& direction) {
    const EnvironmentPoint<F> point = environment_point(view, direction);
    return environment_pixel(view, point.x, point.y);
}

/// Density per solid angle with which sample_environment makes a direction (unit); 0 for a black
/// map.
template <typename F>
OBSCURA_INLINE F environment_pdf(const EnvironmentView& view, const Vec3<F>& direction) {
    const EnvironmentPoint<F> point = environment_point(view, direction);
    const IntOf<F> row = environment_cell(point.y, view.height);
    const IntOf<F> column = environment_cell(point.x, view.width);
    const IntOf<F> pixel = row * IntOf<F>(view.width) + column;
    return environment_density<F>(view, pixel, point.sin_theta);
}

/// Radiance and density of one direction, for less than the two calls: what a BSDF ray that
/// leaves the scene needs.
template <typename F>
OBSCURA_INLINE EnvironmentSample<F> look_up_environment(const EnvironmentView& view,
                                                        const Vec3<F>& direction) {
    const EnvironmentPoint<F> point = environment_point(view, direction);
    const IntOf<F> row = environment_cell(point.y, view.height);
    const IntOf<F> column = environment_cell(point.x, view.width);
    const IntOf<F> pixel = row * IntOf<F>(view.width) + column;
    return {direction,
            environment_pixel(view, point.x, point.y),
            environment_density<F>(view, pixel, point.sin_theta)};
}

/// Chooses a pixel in proportion to its light (row first, then column) and a place inside it,
/// uniform in (u, v).
///
/// In      random: two uniform 32-bit numbers
/// Out     pdf as environment_pdf(direction), but for directions so near a pixel's border that
///         rounding decides: there it is the density of the pixel that was chosen
/// Source  Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, section 12.5
template <typename F>
OBSCURA_INLINE EnvironmentSample<F> sample_environment(const EnvironmentView& view,
                                                       const Vec2<UintOf<F>>& random) {
    const CdfSample<F> row = sample_cdf<F>(view.rows, view.height, random.x);
    const IntOf<F> first = row.index * IntOf<F>(view.width);
    const CdfSample<F> column =
        sample_cdf_at<F>(view.columns, IntOf<F>(first + row.index), view.width, random.y);
    // Half a step of the 24 bits keeps clear of the pixel's borders, and so of the poles.
    const F half_step(0.5f / 16777216.0f);
    const F y = from_int<F>(row.index) + max(unit_float<F>(row.remaining), half_step);
    const F x = from_int<F>(column.index) + max(unit_float<F>(column.remaining), half_step);

    const SinCos<F> polar = sin_cos_turn(y / from_int<F>(IntOf<F>(view.height)) * F(0.5f));
    const SinCos<F> turn = sin_cos_turn(x / from_int<F>(IntOf<F>(view.width)));
    const F sin_theta = max(polar.sin, F(1e-7f));
    const F map_x = -(sin_theta * turn.cos);  // u = 0.5 is +X, so a turn begins at -X
    const F map_z = -(sin_theta * turn.sin);
    const F c(view.cos_rotation);
    const F s(view.sin_rotation);
    return {{map_x * c + map_z * s, polar.cos, map_z * c - map_x * s},
            environment_pixel(view, x, y),
            environment_density<F>(view, first + column.index, sin_theta)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
