// light/shape_light.h - spheres, rectangles and disks as lights, sampled by solid angle or area.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/record_words.h"
#include "light/triangle_light.h"
#include "math/table_record.h"
#include "math/warp.h"

#include <cstdint>

namespace obscura {

/// To add one: a name here; a case in sample_shape_light and in shape_light_density; its choice and
/// its record in light_of of render/shape_light_table.cpp; if it is not flat, its mean emission in
/// render/raycast_lights.cpp; a test in tests/statistics/shape_light_test.cpp.
enum class ShapeLightKind : int32_t {
    sphere,         ///< by solid angle
    rectangle,      ///< by solid angle; by area where that is small
    parallelogram,  ///< by area: a rectangle under a transform with shear
    ellipse         ///< by area
};

/// One emissive shape in world space, 32-bit words only.
struct ShapeLight {
    int32_t kind = 0;  ///< ShapeLightKind
    float centre[3] = {0, 0, 0};
    /// sphere: its unit axes; flat ones: x and z are the half edges or half axes along u and v, y
    /// is the unit normal to the front
    float x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    float radius = 1;               ///< of a sphere
    float area = 0;                 ///< square metres
    float emission[3] = {0, 0, 0};  ///< radiance, before the texture
    float coat = 0;                 ///< as TriangleLight::coat
    int32_t texture = -1;           ///< multiplies emission; -1: none
    float uv_from_shape[6] = {1, 0, 0, 0, 1, 0};
    float select = 0;  ///< probability of choosing this light
    int32_t two_sided = 0;
    int32_t alpha = -1;  ///< as TriangleLight::alpha
};

static_assert(sizeof(ShapeLight) == 29 * 4, "read as 32-bit words: no padding");

inline namespace OBSCURA_ISA {

template <typename F>
struct ShapeLightSample {
    Vec3<F> point;
    Vec3<F> normal;  ///< unit, to the front
    Vec3<F> direction;
    F distance;
    F pdf;  ///< 1/sr, without the choice of the light; 0: no light from here
    Vec2<F> uv;
};

/// A light in registers.
template <typename F>
struct ShapeLightValues {
    IntOf<F> kind;
    Vec3<F> centre, x, y, z;
    F radius, area;
    MaskOf<F> two_sided;
};

template <auto member, typename F>
OBSCURA_INLINE Vec3<F> light_vector(const TableRecord<F, ShapeLight>& record) {
    const auto number = [&](int k) { return record.template number<member>(k); };
    return {number(0), number(1), number(2)};
}

template <typename F>
OBSCURA_INLINE ShapeLightValues<F> read_shape_light(const TableRecord<F, ShapeLight>& record) {
    return {.kind = record.template integer<&ShapeLight::kind>(),
            .centre = light_vector<&ShapeLight::centre>(record),
            .x = light_vector<&ShapeLight::x>(record),
            .y = light_vector<&ShapeLight::y>(record),
            .z = light_vector<&ShapeLight::z>(record),
            .radius = record.template number<&ShapeLight::radius>(),
            .area = record.template number<&ShapeLight::area>(),
            .two_sided = record.template integer<&ShapeLight::two_sided>() != IntOf<F>(0)};
}

/// 1 - cos of the angle that a sphere's radius subtends; without cancellation far away.
template <typename F>
OBSCURA_INLINE F sphere_cap(const F& radius, const F& distance) {
    const F sine = radius / distance;
    const F squared = min(sine * sine, F(1.0f));
    return squared / (F(1.0f) + sqrt(F(1.0f) - squared));
}

/// The solid angle of a rectangle as seen from a point.
/// Source  Urena, Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles",
///         EGSR 2013
template <typename F>
struct SphericalRectangle {
    F x0, x1, y0, y1, z0;  ///< edges in the rectangle's frame; z0 < 0
    F b0, b1, k;
    F solid_angle;
};

/// Smaller rectangles are sampled by area, because angles lose precision.
inline constexpr float smallest_solid_angle = 0.01f;

template <typename F>
OBSCURA_INLINE SphericalRectangle<F> spherical_rectangle(const ShapeLightValues<F>& light,
                                                         const Vec3<F>& from) {
    const F half_x = length(light.x);
    const F half_y = length(light.z);
    const Vec3<F> d = light.centre - from;
    const F x = dot(d, light.x) / half_x;
    const F y = dot(d, light.z) / half_y;
    SphericalRectangle<F> r;
    r.x0 = x - half_x;
    r.x1 = x + half_x;
    r.y0 = y - half_y;
    r.y1 = y + half_y;
    r.z0 = -max(abs(dot(d, light.y)), F(1e-9f) * (half_x + half_y));
    // The normals of the four planes through the point and an edge have two components each.
    const auto across = [&](const F& edge) { return F(1.0f) / sqrt(r.z0 * r.z0 + edge * edge); };
    const F n0 = across(r.y0);
    const F n1 = across(r.x1);
    const F n2 = across(r.y1);
    const F n3 = across(r.x0);
    r.b0 = -(r.y0 * n0);
    r.b1 = r.y1 * n2;
    const F c1 = r.x1 * n1;
    const F c3 = -(r.x0 * n3);
    const auto angle = [](const F& cosine) { return acos(clamp(cosine, F(-1.0f), F(1.0f))); };
    const F g0 = angle(F(-(r.b0 * c1)));
    const F g1 = angle(F(-(c1 * r.b1)));
    const F g2 = angle(F(-(r.b1 * c3)));
    const F g3 = angle(F(-(c3 * r.b0)));
    r.k = F(2.0f * pi_f) - g2 - g3;
    r.solid_angle = g0 + g1 - r.k;
    return r;
}

/// A point on the rectangle, uniform over the solid angle; in -1 to 1 along the half edges.
template <typename F>
OBSCURA_INLINE Vec2<F> sample_spherical_rectangle(const SphericalRectangle<F>& r,
                                                  const Vec2<F>& u) {
    const F tiny(1e-12f);
    const F angle = u.x * r.solid_angle + r.k;
    const F sine = sin_cos(angle).sin;
    const F fu = (sin_cos(angle).cos * r.b0 - r.b1) / select(abs(sine) < tiny, tiny, sine);
    const F along = F(1.0f) / sqrt(max(fu * fu + r.b0 * r.b0, tiny));
    const F cu = clamp(select(fu > F(0.0f), along, F(-along)), F(-0.9999999f), F(0.9999999f));
    const F x = clamp(F(-(cu * r.z0)) / sqrt(F(1.0f) - cu * cu), r.x0, r.x1);
    const F d2 = x * x + r.z0 * r.z0;
    const F h0 = r.y0 / sqrt(d2 + r.y0 * r.y0);
    const F h1 = r.y1 / sqrt(d2 + r.y1 * r.y1);
    const F h = h0 + u.y * (h1 - h0);
    const F rest = F(1.0f) - h * h;
    const F y = select(rest > F(1e-6f), h * sqrt(d2 / max(rest, F(1e-6f))), r.y1);
    const F two(2.0f);
    return {two * (x - r.x0) / (r.x1 - r.x0) - F(1.0f),
            two * (clamp(y, r.y0, r.y1) - r.y0) / (r.y1 - r.y0) - F(1.0f)};
}

template <typename F>
OBSCURA_INLINE MaskOf<F> is_kind(const ShapeLightValues<F>& light, ShapeLightKind kind) {
    return light.kind == IntOf<F>(static_cast<int32_t>(kind));
}

/// True where the point is inside a sphere light, which is then sampled by area.
template <typename F>
OBSCURA_INLINE MaskOf<F> is_inside(const ShapeLightValues<F>& light, const F& distance) {
    return distance <= light.radius * F(1.00001f);
}

/// Density of choosing a direction towards a light by solid angle; `area_density` elsewhere.
///
/// In      cosine: between the light's normal at the hit point and the direction back
template <typename F>
OBSCURA_INLINE F shape_light_density(const ShapeLightValues<F>& light,
                                     const Vec3<F>& from,
                                     const F& distance,
                                     const F& cosine) {
    const F facing = select(light.two_sided, abs(cosine), cosine);
    F pdf = solid_angle_pdf<F>(F(1.0f) / light.area, distance, facing);
    const auto lit = facing > F(0.0f);
    const auto sphere = is_kind(light, ShapeLightKind::sphere);
    if (any(sphere)) {
        const F away = length(light.centre - from);
        const F cap = F(1.0f) / (F(2.0f * pi_f) * sphere_cap(light.radius, away));
        pdf = select(sphere & (!is_inside(light, away)) & lit, cap, pdf);
    }
    const auto rectangle = is_kind(light, ShapeLightKind::rectangle);
    if (any(rectangle)) {
        const F angle = spherical_rectangle(light, from).solid_angle;
        const auto large = rectangle & (angle > F(smallest_solid_angle)) & lit;
        pdf = select(large, F(1.0f) / max(angle, F(smallest_solid_angle)), pdf);
    }
    return pdf;
}

/// Texture coordinates of a sphere light at a unit normal: as shape/sphere.h.
template <typename F>
OBSCURA_INLINE Vec2<F> sphere_light_uv(const ShapeLightValues<F>& light, const Vec3<F>& n) {
    const F x = dot(n, light.x);
    const F y = dot(n, light.y);
    const F z = dot(n, light.z);
    return {atan2(x, z) * F(0.5f / pi_f) + F(0.5f),
            atan2(F(sqrt(x * x + z * z)), y) * F(1.0f / pi_f)};
}

/// Samples a point on a sphere light, as its normal: within the cone towards it, or from inside
/// over the whole sphere.
/// Source  Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations",
///         ACM TOG 15(1), 1996
template <typename F>
OBSCURA_INLINE Vec3<F> sample_sphere_light(const ShapeLightValues<F>& light,
                                           const Vec2<F>& u,
                                           const Vec3<F>& from) {
    const Vec3<F> to_centre = light.centre - from;
    const F away = length(to_centre);
    const auto inside = is_inside(light, away);
    const Frame<F> frame = frame_around(normalize(to_centre));
    const F cap = sphere_cap(light.radius, max(away, light.radius));
    const F one_minus = u.x * cap;  // of the cosine
    const F sine2 = max(one_minus * (F(2.0f) - one_minus), F(0.0f));
    const SinCos<F> turn = sin_cos_turn(u.y);
    const F sine = sqrt(sine2);
    const F half = sqrt(max(light.radius * light.radius - away * away * sine2, F(0.0f)));
    const F along = away * (F(1.0f) - one_minus) - half;
    const Vec3<F> local{
        sine * turn.cos * along, sine * turn.sin * along, (F(1.0f) - one_minus) * along - away};
    return select(inside, uniform_sphere(u), normalize(to_world(frame, local)));
}

/// Samples a point on a light, as seen from `from`.
///
/// In      u: [0,1)^2
/// Out     the light reaches `from` when pdf > 0; estimate: emission * texture / pdf
template <typename F>
OBSCURA_INLINE ShapeLightSample<F> sample_shape_light(const ShapeLightValues<F>& light,
                                                      const Vec2<F>& u,
                                                      const Vec3<F>& from) {
    const F one(1.0f);
    Vec2<F> flat{F(2.0f) * u.x - one, F(2.0f) * u.y - one};
    const auto ellipse = is_kind(light, ShapeLightKind::ellipse);
    if (any(ellipse)) {
        const SinCos<F> turn = sin_cos_turn(u.y);
        const F radius = sqrt(u.x);
        flat = {select(ellipse, radius * turn.cos, flat.x),
                select(ellipse, radius * turn.sin, flat.y)};
    }
    const auto rectangle = is_kind(light, ShapeLightKind::rectangle);
    if (any(rectangle)) {
        const SphericalRectangle<F> seen = spherical_rectangle(light, from);
        const auto large = rectangle & (seen.solid_angle > F(smallest_solid_angle));
        const Vec2<F> by_angle = sample_spherical_rectangle(seen, u);
        flat = {select(large, by_angle.x, flat.x), select(large, by_angle.y, flat.y)};
    }
    ShapeLightSample<F> s;
    s.normal = light.y;
    s.point = light.centre + light.x * flat.x + light.z * flat.y;
    s.uv = {flat.x * F(0.5f) + F(0.5f), flat.y * F(0.5f) + F(0.5f)};
    const auto sphere = is_kind(light, ShapeLightKind::sphere);
    if (any(sphere)) {
        const Vec3<F> n = sample_sphere_light(light, u, from);
        const Vec2<F> uv = sphere_light_uv(light, n);
        s.normal = select(sphere, n, s.normal);
        s.point = select(sphere, light.centre + n * light.radius, s.point);
        s.uv = {select(sphere, uv.x, s.uv.x), select(sphere, uv.y, s.uv.y)};
    }
    const Vec3<F> to_light = s.point - from;
    s.distance = length(to_light);
    s.direction = to_light * (one / max(s.distance, F(1e-18f)));
    s.pdf = shape_light_density(light, from, s.distance, F(-dot(s.normal, s.direction)));
    return s;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
