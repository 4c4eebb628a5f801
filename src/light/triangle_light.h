// light/triangle_light.h - an emissive triangle, sampled uniformly over its area.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/record_words.h"
#include "math/gather4.h"
#include "math/vec.h"
#include "surface/fresnel.h"

#include <cstdint>

namespace obscura {

/// One emissive triangle in world space, 32-bit words only.
struct TriangleLight {
    float p0[3] = {0, 0, 0};
    float e1[3] = {0, 0, 0};        ///< to the second vertex
    float e2[3] = {0, 0, 0};        ///< to the third; cross(e1, e2) points to the front
    float emission[3] = {0, 0, 0};  ///< radiance, before the texture
    float coat = 0;                 ///< clearcoat factor times its texture's mean
    float uv0[2] = {0, 0};
    float uv1[2] = {0, 0};
    float uv2[2] = {0, 0};
    int32_t texture = -1;   ///< multiplies emission; -1: none
    float area = 0;         ///< square metres
    float pdf_area = 0;     ///< probability of choosing this triangle / area; 0 when area is 0
    int32_t two_sided = 0;  ///< 1: also emits from the back
    int32_t motion = -1;    ///< first index in LightView::moving_triangles; -1: it stands still
    int32_t alpha = -1;     ///< index in LightView::alphas; -1: it is opaque
};

static_assert(sizeof(TriangleLight) == 25 * 4, "read as 32-bit words: no padding");

/// Corner and edges of a moving triangle at one time.
struct MovingTriangle {
    float p0[3] = {0, 0, 0};
    float e1[3] = {0, 0, 0};
    float e2[3] = {0, 0, 0};
};

/// A light with corners, edges and area; the rest stays at its default. Corners that are equal,
/// collinear or not finite give the area 0.
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
    Vec3<F> emission;  ///< before texture and alpha, behind the coat
    Vec2<F> weight;    ///< barycentric, of the second and the third corner
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

/// A triangle for each lane.
template <typename F>
struct TriangleCorners {
    Vec3<F> p0, e1, e2;
    F area;
    F pdf_area;
};

/// Four neighbouring words of lights[index], all of them within the record.
template <typename F>
OBSCURA_INLINE Four<F> read_four(const TriangleLight* lights,
                                 const IntOf<F>& index,
                                 size_t byte_offset) {
    return gather4<F>(member_words<float>(lights, byte_offset),
                      IntOf<F>(index * IntOf<F>(words_per_record<TriangleLight>)));
}

/// In      index must be in range for idle lanes too
template <typename F>
OBSCURA_INLINE TriangleCorners<F> read_corners(const TriangleLight* lights, const IntOf<F>& index) {
    const auto read = [&](size_t offset) { return read_four<F>(lights, index, offset); };
    const Four<F> p0_e1 = read(offsetof(TriangleLight, p0));
    const Four<F> e1_e2 = read(offsetof(TriangleLight, e1) + 4);
    const Four<F> e2_on = read(offsetof(TriangleLight, e2) + 8);
    const Four<F> area_on = read(offsetof(TriangleLight, area));
    static_assert(offsetof(TriangleLight, e1) == 12 && offsetof(TriangleLight, e2) == 24 &&
                  offsetof(TriangleLight, pdf_area) == offsetof(TriangleLight, area) + 4);
    return {{p0_e1.x, p0_e1.y, p0_e1.z},
            {p0_e1.w, e1_e2.x, e1_e2.y},
            {e1_e2.z, e1_e2.w, e2_on.x},
            area_on.x,
            area_on.y};
}

/// A point on triangle lights[index], uniform over its area, as seen from `from`.
///
/// In      corners: where the triangle is; u: [0,1)^2; index must be in range for idle lanes too
/// Out     the light reaches `from` when pdf > 0; estimate: emission * texture / pdf
template <typename F>
OBSCURA_INLINE TriangleLightSample<F> sample_triangle_light(const TriangleLight* lights,
                                                            const IntOf<F>& index,
                                                            const TriangleCorners<F>& corners,
                                                            const Vec2<F>& u,
                                                            const Vec3<F>& from) {
    const auto read = [&](size_t offset) { return read_four<F>(lights, index, offset); };
    const Four<F> emission = read(offsetof(TriangleLight, emission));
    const Four<F> uv0_uv1 = read(offsetof(TriangleLight, uv0));
    const Four<F> uv2_on = read(offsetof(TriangleLight, uv2));
    static_assert(offsetof(TriangleLight, uv1) == offsetof(TriangleLight, uv0) + 8);
    const auto read_int = [&](size_t offset) {
        return gather<F>(member_words<int32_t>(lights, offset),
                         IntOf<F>(index * IntOf<F>(words_per_record<TriangleLight>)));
    };
    const Vec2<F> weight = triangle_from_square(u);
    const Vec3<F>& e1 = corners.e1;
    const Vec3<F>& e2 = corners.e2;
    TriangleLightSample<F> sample;
    sample.weight = weight;
    sample.point = corners.p0 + weight.x * e1 + weight.y * e2;

    // Divided by the area first: the square of a tiny triangle's cross product would underflow.
    const Vec3<F> scaled = cross(e1, e2 * (F(0.5f) / max(corners.area, F(1e-36f))));
    const auto proper = corners.area > F(0.0f);
    sample.normal = select(proper, normalize(scaled), splat3(F(0.0f)));

    const Vec3<F> to_light = sample.point - from;
    sample.distance = length(to_light);
    sample.direction = to_light * (F(1.0f) / max(sample.distance, F(1e-18f)));
    sample.cosine = -dot(sample.normal, sample.direction);
    const auto both = read_int(offsetof(TriangleLight, two_sided)) != IntOf<F>(0);
    const F facing = select(both, abs(sample.cosine), sample.cosine);
    sample.pdf = solid_angle_pdf<F>(corners.pdf_area, sample.distance, facing);

    static_assert(offsetof(TriangleLight, coat) == offsetof(TriangleLight, emission) + 12);
    sample.emission = Vec3<F>{emission.x, emission.y, emission.z} *
                      coat_transmittance<F>(emission.w, abs(sample.cosine));
    sample.texture = read_int(offsetof(TriangleLight, texture));
    const Vec2<F> uv0{uv0_uv1.x, uv0_uv1.y};
    const Vec2<F> uv1{uv0_uv1.z, uv0_uv1.w};
    const Vec2<F> uv2{uv2_on.x, uv2_on.y};
    sample.uv = uv0 + (uv1 - uv0) * weight.x + (uv2 - uv0) * weight.y;
    return sample;
}

/// The same for a triangle that stands still.
template <typename F>
OBSCURA_INLINE TriangleLightSample<F> sample_triangle_light(const TriangleLight* lights,
                                                            const IntOf<F>& index,
                                                            const Vec2<F>& u,
                                                            const Vec3<F>& from) {
    return sample_triangle_light<F>(lights, index, read_corners<F>(lights, index), u, from);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
