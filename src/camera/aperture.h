// camera/aperture.h - samples points on a lens: a disk, a polygon, or in proportion to an image.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera_ray.h"
#include "math/warp.h"

namespace obscura {

/// Side of the square aperture image in pixels; larger images are averaged down to it.
inline constexpr int aperture_size = 128;

/// Running sums of an image's brightness, each ending at exactly 1.
struct ApertureView {
    const float* rows = nullptr;     ///< aperture_size sums; null: there is no image
    const float* columns = nullptr;  ///< aperture_size sums for each row
};

struct Aperture {
    float radius_m = 0;        ///< of the disk, or of the circle through the polygon's corners
    int blades = 0;            ///< 3 or more: a regular polygon; else a disk
    float rotation_turns = 0;  ///< of the polygon or image, counter-clockwise seen from behind
    float squeeze = 1;         ///< width / height of the opening; anamorphic X is 1 / X
    ApertureView image;
};

inline namespace OBSCURA_ISA {

/// The fractional part of a rotation in turns, in [0, 1).
template <typename F>
OBSCURA_INLINE F wrapped_turn(const F& t) {
    return t - floor(t);
}

/// Uniform on the unit disk.
template <typename F>
OBSCURA_INLINE Vec2<F> disk_point(const Vec2<F>& u) {
    const F radius = sqrt(u.x);
    const SinCos<F> turn = sin_cos_turn(u.y);
    return {radius * turn.cos, radius * turn.sin};
}

/// Uniform on a regular polygon inscribed in the unit circle, one corner at the top.
template <typename F>
OBSCURA_INLINE Vec2<F> polygon_point(int blades, const Vec2<F>& u) {
    const F n = F(static_cast<float>(blades));
    const F scaled = u.x * n;
    const F sector = min(floor(scaled), n - F(1.0f));
    const F along = sqrt(scaled - sector);  // from the centre: areas grow with its square
    const F first = F(0.25f) + sector / n;
    const SinCos<F> a = sin_cos_turn(wrapped_turn(first));
    const SinCos<F> b = sin_cos_turn(wrapped_turn(first + F(1.0f) / n));
    return {along * lerp(a.cos, b.cos, u.y), along * lerp(a.sin, b.sin, u.y)};
}

/// A cell found in running sums, and the position in it.
template <typename F>
struct SumCell {
    IntOf<F> index;
    F fraction;  ///< [0, 1]
};

/// The first of aperture_size sums that exceeds u, by bisection; `base` is where they start.
template <typename F>
OBSCURA_INLINE SumCell<F> find_in_sums(const float* sums, const IntOf<F>& base, const F& u) {
    IntOf<F> index = IntOf<F>(0);
    for (int step = aperture_size / 2; step > 0; step /= 2) {
        const F sum = gather<F>(sums, base + index + IntOf<F>(step - 1));
        index = index + select(sum <= u, IntOf<F>(step), IntOf<F>(0));
    }
    const F high = gather<F>(sums, base + index);
    const F low = select(index > IntOf<F>(0),
                         gather<F>(sums, base + max(index - IntOf<F>(1), IntOf<F>(0))),
                         F(0.0f));
    return {index, clamp((u - low) / max(high - low, F(1e-30f)), F(0.0f), F(1.0f))};
}

/// A point of the image, which fills [-1,1]^2, with a density in proportion to its brightness.
template <typename F>
OBSCURA_INLINE Vec2<F> image_point(const ApertureView& image, const Vec2<F>& u) {
    const SumCell<F> row = find_in_sums(image.rows, IntOf<F>(0), u.y);
    const SumCell<F> column = find_in_sums(image.columns, row.index * IntOf<F>(aperture_size), u.x);
    const F scale = F(2.0f / aperture_size);
    return {(from_int<F>(column.index) + column.fraction) * scale - F(1.0f),
            F(1.0f) - (from_int<F>(row.index) + row.fraction) * scale};
}

/// A point on the lens, metres, x to the right, y up.
///
/// In      u: uniform in [0,1)^2
/// Out     uniform on the disk or polygon; for an image, in proportion to its brightness
/// Source  Shirley and Chiu, "A Low Distortion Map Between Disk and Square", 1997, on why any
///         area-preserving map will do
template <typename F>
OBSCURA_INLINE Vec2<F> lens_point(const Aperture& aperture, const Vec2<F>& u) {
    Vec2<F> p;
    if (aperture.image.rows != nullptr) {
        p = image_point(aperture.image, u);
    } else if (aperture.blades >= 3) {
        p = polygon_point(aperture.blades, u);
    } else {
        p = disk_point(u);
    }
    const SinCos<F> turn = sin_cos_turn(F(aperture.rotation_turns));
    const Vec2<F> turned{p.x * turn.cos - p.y * turn.sin, p.x * turn.sin + p.y * turn.cos};
    const F radius = F(aperture.radius_m);
    return {turned.x * radius * F(aperture.squeeze), turned.y * radius};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
