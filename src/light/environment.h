// light/environment.h - the environment light: look-up, density and importance sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/pixel_choice.h"
#include "math/gather4.h"
#include "math/sampler.h"
#include "math/vec.h"
#include "math/warp.h"

namespace obscura {

/// A view of an EnvironmentTable (light/environment_table.h), which owns the arrays.
///
/// The map is latitude-longitude: u = atan2(z, x) / 2 pi + 0.5, v = acos(y) / pi; +Y is row 0.
struct EnvironmentView {
    /// 4 floats a pixel, so that a look-up reads one cache line: the radiance, and the density per
    /// solid angle with which the pixel is sampled, times sin(theta)
    const float* pixels = nullptr;
    PixelChoiceView choice;  ///< draws a pixel, bright ones most often
    int32_t width = 1;
    int32_t height = 1;
    float cos_rotation = 1;  ///< of the map's rotation about +Y,
    float sin_rotation = 0;  ///< counter-clockwise seen from above
};

inline namespace OBSCURA_ISA {

template <typename F>
struct EnvironmentSample {
    Vec3<F> direction;  ///< world, unit
    Vec3<F> radiance;   ///< of one pixel, see finish_environment_draw
    F pdf;              ///< 1/sr, of that pixel; 0 when the map is black
};

/// A direction's position on the map, in pixels, and the sine of its polar angle.
template <typename F>
struct EnvironmentPoint {
    F x, y;  ///< in [0, width], [0, height]
    F sin_theta;
};

/// The position of a world direction on the map. The polar angle is an arc tangent because the arc
/// cosine loses half the digits near the poles.
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

/// The four pixels around a direction: left and right of one row, then of the next.
template <typename F>
struct EnvironmentCell {
    IntOf<F> word[4];  ///< first of each pixel
    F right, down;     ///< weights of the second column and the second row
    F sin_theta;       ///< of the direction
};

/// The four pixels of the bilinear interpolation for one direction. Their weights sum to 1.
template <typename F>
struct EnvironmentTaps {
    Vec3<F> radiance[4];
    F pdf[4];  ///< 1/sr, of sampling this direction from this pixel, divided by its weight
    F weight[4];
};

/// Density per solid angle from a pixel's density times sin(theta).
template <typename F>
OBSCURA_INLINE F environment_density(const F& times_sine, const F& sin_theta) {
    return times_sine / max(sin_theta, F(1e-7f));
}

/// The four pixels around a direction: the map wraps around in x and stops at the first and last
/// row.
template <typename F>
OBSCURA_INLINE EnvironmentCell<F> environment_cell(const EnvironmentView& view,
                                                   const Vec3<F>& direction) {
    using I = IntOf<F>;
    const EnvironmentPoint<F> point = environment_point(view, direction);
    // Clamped so that NaN stays in the map too.
    const F from_x = clamp(point.x - F(0.5f), F(-1.0f), from_int<F>(I(view.width - 1)) + F(0.5f));
    const F from_y = clamp(point.y - F(0.5f), F(0.0f), from_int<F>(I(view.height - 1)));
    const F floor_x = floor(from_x);
    const F floor_y = floor(from_y);
    const F right = from_x - floor_x;
    const F down = from_y - floor_y;
    const I column = to_int(floor_x);
    const I column0 = select(column < I(0), I(view.width - 1), column);
    const I column1 = select(column >= I(view.width - 1), I(0), column + I(1));
    const I row0 = to_int(floor_y);
    const I row1 = min(row0 + I(1), I(view.height - 1));

    const auto word = [&](const I& row, const I& column_at) {
        return I((row * I(view.width) + column_at) * I(4));
    };
    return {{word(row0, column0), word(row0, column1), word(row1, column0), word(row1, column1)},
            right,
            down,
            point.sin_theta};
}

/// Draws one pixel of a cell with its weight in bilinear interpolation: unbiased, with a quarter of
/// the memory traffic. The weight is part of the density in both strategies, so that multiple
/// importance sampling compares the joint densities of direction and pixel.
///
/// In   random: uniform 32-bit numbers; halves of 16 bits are used
/// Out  the first word of the pixel
template <typename F>
OBSCURA_INLINE IntOf<F> choose_environment_pixel(const EnvironmentCell<F>& cell,
                                                 const UintOf<F>& random) {
    const F unit(1.0f / 65536.0f);  // steps of 2^-16, sampled at their centres
    const auto is_right =
        (from_int<F>(as_int(random & UintOf<F>(0xFFFFU))) + F(0.5f)) * unit < cell.right;
    const auto is_down = (from_int<F>(as_int(random >> 16)) + F(0.5f)) * unit < cell.down;
    return select(is_down,
                  select(is_right, cell.word[3], cell.word[2]),
                  select(is_right, cell.word[1], cell.word[0]));
}

/// Reads the pixels of a cell.
template <typename F>
OBSCURA_INLINE EnvironmentTaps<F> environment_taps(const EnvironmentView& view,
                                                   const EnvironmentCell<F>& cell) {
    const F left = F(1.0f) - cell.right;
    const F up = F(1.0f) - cell.down;
    const F weight[4] = {left * up, cell.right * up, left * cell.down, cell.right * cell.down};
    EnvironmentTaps<F> taps;
    for (int i = 0; i < 4; ++i) {
        const Four<F> pixel = gather4<F>(view.pixels, cell.word[i]);
        taps.radiance[i] = {pixel.x, pixel.y, pixel.z};
        taps.pdf[i] = environment_density(pixel.w, cell.sin_theta);
        taps.weight[i] = weight[i];
    }
    return taps;
}

template <typename F>
OBSCURA_INLINE EnvironmentTaps<F> environment_taps(const EnvironmentView& view,
                                                   const Vec3<F>& direction) {
    return environment_taps(view, environment_cell(view, direction));
}

template <typename F>
OBSCURA_INLINE Vec3<F> mix(const EnvironmentTaps<F>& taps) {
    Vec3<F> sum = taps.weight[0] * taps.radiance[0];
    for (int i = 1; i < 4; ++i)
        sum = sum + taps.weight[i] * taps.radiance[i];
    return sum;
}

/// Radiance that arrives from a world direction (unit).
template <typename F>
OBSCURA_INLINE Vec3<F> environment_radiance(const EnvironmentView& view, const Vec3<F>& direction) {
    return mix(environment_taps(view, direction));
}

/// Density per solid angle with which sample_environment draws a direction (unit), over all pixels;
/// 0 for a black map.
template <typename F>
OBSCURA_INLINE F environment_pdf(const EnvironmentView& view, const Vec3<F>& direction) {
    const EnvironmentTaps<F> taps = environment_taps(view, direction);
    F sum = taps.weight[0] * taps.pdf[0];
    for (int i = 1; i < 4; ++i)
        sum = sum + taps.weight[i] * taps.pdf[i];
    return sum;
}

/// An offset x in [-1, 1] with the density 1 - |x|, which is a pixel's weight in interpolation.
template <typename F>
OBSCURA_INLINE F tent(const F& u) {
    const F a = F(2.0f) * u - F(1.0f);
    const F size = F(1.0f) - sqrt(max(F(1.0f) - abs(a), F(0.0f)));
    return select(a < F(0.0f), -size, size);
}

/// Chooses the pixel of a draw_block, and prefetches it.
template <typename F>
OBSCURA_INLINE void draw_environment_pixel(const EnvironmentView& view, PixelDraw<F>& draw) {
    draw_pixel(view.choice, draw);
    const IntOf<F> pixel = draw.row * IntOf<F>(view.width) + draw.column;
    prefetch<F>(view.pixels, IntOf<F>(pixel * IntOf<F>(4)));
}

/// Chooses a pixel by its sampling weight, and a position around it with the pixel's bilinear
/// weight as density. The map is a sum of weighted pixels: this draws one term of the sum together
/// with a direction. So radiance / pdf is that of one pixel, even where bright and dark pixels
/// meet, and one pixel is read. BSDF sampling draws the direction first; its density of a term is
/// that of the direction times the weight. The weight cancels in the ratio of both densities:
/// multiple importance sampling compares the chosen pixel's pdf with the BSDF's pdf.
///
/// Out     radiance and pdf of the chosen pixel, both without its weight, which cancels too
/// Source  Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, section 12.5, for
///         the choice of pixels; Veach, PhD thesis, 1997, section 9.2, holds in the joint space
template <typename F>
OBSCURA_INLINE EnvironmentSample<F> finish_environment_draw(const EnvironmentView& view,
                                                            const PixelDraw<F>& draw) {
    using I = IntOf<F>;
    const F height = from_int<F>(I(view.height));
    // Positions past a pole are mirrored back: there the pixel's weight is 1 up to the border.
    F y = abs(from_int<F>(draw.row) + F(0.5f) + tent(draw.left.y));
    y = min(y, F(2.0f) * height - y);
    const F x = from_int<F>(draw.column) + F(0.5f) + tent(draw.left.x);

    const SinCos<F> polar = sin_cos_turn(y / height * F(0.5f));
    const SinCos<F> turn = sin_cos_turn(x / from_int<F>(I(view.width)));
    const F sin_theta = max(polar.sin, F(1e-7f));
    const F map_x = -(sin_theta * turn.cos);  // u = 0.5 is +X, so rotations begin at -X
    const F map_z = -(sin_theta * turn.sin);
    const F c(view.cos_rotation);
    const F s(view.sin_rotation);
    const Four<F> pixel =
        gather4<F>(view.pixels, I((draw.row * I(view.width) + draw.column) * I(4)));
    return {{map_x * c + map_z * s, polar.cos, map_z * c - map_x * s},
            {pixel.x, pixel.y, pixel.z},
            environment_density(pixel.w, sin_theta)};
}

/// All steps at once.
template <typename F>
OBSCURA_INLINE EnvironmentSample<F> sample_environment(const EnvironmentView& view,
                                                       const Vec2<UintOf<F>>& random) {
    PixelDraw<F> draw = draw_block<F>(view.choice, random);
    draw_environment_pixel(view, draw);
    return finish_environment_draw(view, draw);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
