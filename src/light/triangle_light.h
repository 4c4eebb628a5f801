// light/triangle_light.h - an emissive triangle, sampled uniformly over its area.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/row_words.h"
#include "math/gather4.h"
#include "math/vec.h"

#include <cstdint>

namespace obscura {

/// One emissive triangle in world space, 32-bit words only.
struct TriangleLight {
    float p0[3] = {0, 0, 0};
    float e1[3] = {0, 0, 0};        ///< to the second vertex
    float e2[3] = {0, 0, 0};        ///< to the third; cross(e1, e2) points to the front
    float emission[3] = {0, 0, 0};  ///< radiance, before the texture
    float uv0[2] = {0, 0};
    float uv1[2] = {0, 0};
    float uv2[2] = {0, 0};
    int32_t texture = -1;   ///< multiplies emission; -1: none
    float area = 0;         ///< square metres
    float pdf_area = 0;     ///< probability of choosing this triangle / area; 0 when area is 0
    int32_t two_sided = 0;  ///< 1: also emits from the back
};

static_assert(sizeof(TriangleLight) == 22 * 4, "read as 32-bit words: no padding");

/// Corners, edges and area of a row; the rest stays at its default. Corners that are equal, in a
/// line or not finite give the area 0.
TriangleLight make_triangle_light(const Vec3f& p0, const Vec3f& p1, const Vec3f& p2);

inline namespace OBSCURA_ISA {

template <typename F>
struct TriangleLightSample {
    Vec3<F> point;
    Vec3<F> normal;     ///< geometric, unit, to the front; zero for a degenerate triangle
    Vec3<F> direction;  ///< unit, from the lit point to the light
    F distance;         ///< metres
    F cosine;           ///< between normal and -direction: negative when seen from behind
    /// 1/sr, the choice of the triangle included (it is part of pdf_area); 0: no light from here
    F pdf;
    Vec3<F> emission;  ///< before the texture
    Vec2<F> uv;
    IntOf<F> texture;
};

/// Maps the unit square to barycentric weights of the second and third corner, uniformly.
/// Source  Heitz, "A Low-Distortion Map Between Triangle and Square", 2019
template <typename F>
OBSCURA_INLINE Vec2<F> triangle_from_square(const Vec2<F>& u) {
    const F half_x = F(0.5f) * u.x;
    const F half_y = F(0.5f) * u.y;
    const auto upper = u.y > u.x;
    return {select(upper, half_x, u.x - half_y), select(upper, u.y - half_x, half_y)};
}

/// Density per solid angle of a point on a light, seen from `distance` away.
///
/// In      pdf_area: per square metre; cosine: at the light, > 0 when it faces the viewer
/// Out     0 for cosine <= 0; always finite
template <typename F>
OBSCURA_INLINE F solid_angle_pdf(const F& pdf_area, const F& distance, const F& cosine) {
    const F pdf = pdf_area * distance * distance / max(cosine, F(1e-12f));
    return select(cosine > F(0.0f), min(pdf, F(1e30f)), F(0.0f));
}

/// A point on triangle rows[index], uniform over its area, as seen from `from`.
///
/// In      u: [0,1)^2; index must be in range for idle lanes too
/// Out     the light reaches `from` when pdf > 0; estimate: emission * texture / pdf
template <typename F>
OBSCURA_INLINE TriangleLightSample<F> sample_triangle_light(const TriangleLight* rows,
                                                            const IntOf<F>& index,
                                                            const Vec2<F>& u,
                                                            const Vec3<F>& from) {
    // Fours of neighbouring words, the last two of which overlap by two.
    const IntOf<F> row = index * IntOf<F>(words_per_row<TriangleLight>);
    const auto read = [&](int word) {
        return gather4<F>(member_words<float>(rows, 4 * static_cast<size_t>(word)), row);
    };
    const Four<F> w0 = read(0);
    const Four<F> w4 = read(4);
    const Four<F> w8 = read(8);
    const Four<F> w12 = read(12);
    const Four<F> w16 = read(16);
    const Four<F> w18 = read(18);
    static_assert(offsetof(TriangleLight, e1) == 12 && offsetof(TriangleLight, e2) == 24 &&
                  offsetof(TriangleLight, emission) == 36 && offsetof(TriangleLight, uv0) == 48 &&
                  offsetof(TriangleLight, uv1) == 56 && offsetof(TriangleLight, uv2) == 64 &&
                  offsetof(TriangleLight, texture) == 72 && offsetof(TriangleLight, area) == 76 &&
                  offsetof(TriangleLight, pdf_area) == 80 &&
                  offsetof(TriangleLight, two_sided) == 84);
    const Vec2<F> weight = triangle_from_square(u);
    const Vec3<F> e1{w0.w, w4.x, w4.y};
    const Vec3<F> e2{w4.z, w4.w, w8.x};
    TriangleLightSample<F> sample;
    sample.point = Vec3<F>{w0.x, w0.y, w0.z} + weight.x * e1 + weight.y * e2;

    // Divided by the area first: the square of a tiny triangle's cross product would underflow.
    const F& area = w18.y;
    const Vec3<F> scaled = cross(e1, e2 * (F(0.5f) / max(area, F(1e-36f))));
    const auto proper = area > F(0.0f);
    sample.normal = select(proper, normalize(scaled), splat3(F(0.0f)));

    const Vec3<F> to_light = sample.point - from;
    sample.distance = length(to_light);
    sample.direction = to_light * (F(1.0f) / max(sample.distance, F(1e-18f)));
    sample.cosine = -dot(sample.normal, sample.direction);
    const auto both = float_bits(w18.w) != IntOf<F>(0);
    const F facing = select(both, abs(sample.cosine), sample.cosine);
    sample.pdf = solid_angle_pdf<F>(w18.z, sample.distance, facing);

    sample.emission = {w8.y, w8.z, w8.w};
    sample.texture = float_bits(w18.x);
    const Vec2<F> uv0{w12.x, w12.y};
    sample.uv =
        uv0 + (Vec2<F>{w12.z, w12.w} - uv0) * weight.x + (Vec2<F>{w16.x, w16.y} - uv0) * weight.y;
    return sample;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
