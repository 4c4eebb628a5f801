// stages/3_geometry.h - from a hit to its position and normals in world space.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_shape.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// One UV set at the hits.
struct MeshUv {
    LanesI base;  ///< as Primitive::uv_base
    Vec2<Lanes> at;
    Lanes area2;  ///< twice the triangle's signed area in UV space
};

/// A hit's geometry in world space.
struct HitGeometry {
    TableRecord<Lanes, Primitive> primitive;
    TableRecord<Lanes, Material> material;
    bool one_triangle;     ///< all lanes hit the same triangle: usual for neighbouring camera rays
    LanesI corner[3];      ///< absolute vertex indices
    Lanes weight[3];       ///< barycentric
    Vec3<Lanes> position;  ///< from the corners, not from the ray: error is bounded
    Vec3<Lanes> ng;        ///< geometric normal, unit, to the front
    Vec3<Lanes> normal;    ///< interpolated, unit, to the front
    Lanes offset;  ///< distance along ng at which rays start without hitting their own triangle
    Vec3<Lanes> smooth_shift;  ///< from position to the smooth surface, to the front
    Lanes area2;               ///< twice the triangle's area
    MeshUv first_uv;           ///< of UV set 0, read where a texture may need it
    bool has_shapes = false;   ///< some lanes hit analytic shapes: their tangents are below
    Mask shapes;
    Vec3<Lanes> dpdu, dpdv;  ///< world space
};

OBSCURA_INLINE Vec3<Lanes> weighted(const HitGeometry& g, const Vec3<Lanes> (&v)[3]) {
    return v[0] * g.weight[0] + v[1] * g.weight[1] + v[2] * g.weight[2];
}

/// The offset from the flat triangle to the smooth surface that the vertex normals describe: shadow
/// rays that start there do not graze the facets.
/// Source  Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021, ch. 4
OBSCURA_INLINE Vec3<Lanes> smooth_surface_shift(const HitGeometry& g,
                                                const Vec3<Lanes> (&p)[3],
                                                const Vec3<Lanes> (&n)[3],
                                                const Vec3<Lanes>& position) {
    Vec3<Lanes> shift = splat3(Lanes(0.0f));
    for (int k = 0; k < 3; ++k) {
        const Vec3<Lanes> up = select(dot(n[k], g.ng) < Lanes(0.0f), -n[k], n[k]);
        // Only outwards: a corner whose tangent plane lies above the point.
        const Lanes below = min(dot(position - p[k], up), Lanes(0.0f));
        shift = shift - up * (below * g.weight[k]);
    }
    // The limit is for boxes with averaged normals, which are not meant as spheres.
    const Lanes max_length = Lanes(0.05f) * sqrt(g.area2);
    return shift * min(Lanes(1.0f), max_length / max(length(shift), Lanes(1e-30f)));
}

/// HitGeometry::offset: the rounding of the barycentric sum and of Embree's own arithmetic, 2^-24
/// each step.
OBSCURA_INLINE Lanes rounding_offset(const HitGeometry& g, const Vec3<Lanes> (&p)[3]) {
    const Vec3<Lanes> size =
        abs(p[0]) * g.weight[0] + abs(p[1]) * g.weight[1] + abs(p[2]) * g.weight[2];
    const Lanes extent = max_component(max3(abs(p[1] - p[0]), abs(p[2] - p[0])));
    return Lanes(32.0f / 16777216.0f) * (dot(abs(g.ng), size) + extent * Lanes(0.25f));
}

/// The face's normal and area.
OBSCURA_INLINE void set_face(float scale, const Vec3<Lanes> (&p)[3], HitGeometry& g) {
    Vec3<Lanes> a = p[1] - p[0];
    Vec3<Lanes> b = p[2] - p[0];
    if (scale != 1.0f) {
        a = a * Lanes(scale);
        b = b * Lanes(scale);
    }
    const Vec3<Lanes> face = cross(a, b);
    g.ng = normalize(face);
    g.area2 = length(face);
    if (scale != 1.0f) g.area2 = g.area2 * Lanes(1.0f / scale) * Lanes(1.0f / scale);
}

/// What the caller needs of a hit: AOVs start no rays and need no offset.
enum class HitUse { attributes, start_rays };

/// HitGeometry::normal and smooth_shift, where vertices have normals.
///
/// In  p: the corners, where they are at the time of the hit
template <HitUse use>
OBSCURA_INLINE void interpolate_normal(const SceneView& scene,
                                       const HitLanes& hit,
                                       const Vec3<Lanes> (&p)[3],
                                       HitGeometry& g) {
    const LanesI normal_base = g.primitive.integer<&Primitive::normal_base>();
    Mask smooth = normal_base != LanesI(no_attribute);
    if (g.has_shapes) smooth = smooth & !g.shapes;
    if (none(smooth)) return;
    Vec3<Lanes> n[3];
    for (int k = 0; k < 3; ++k) {
        const LanesI word = normal_base + g.corner[k] * LanesI(3);
        n[k] = read_corner3(scene.attributes, select(smooth, word, LanesI(0)), g.one_triangle);
    }
    if (scene.motion.normals != nullptr) {
        const CornerVectors moved = moved_corners(
            scene, scene.motion.normals, {g.primitive, g.corner, hit.time}, {{n[0], n[1], n[2]}});
        for (int k = 0; k < 3; ++k)
            n[k] = moved.at[k];
    }
    if constexpr (use == HitUse::start_rays) {
        g.smooth_shift =
            select(smooth, smooth_surface_shift(g, p, n, g.position), splat3(Lanes(0.0f)));
    }
    if (scene.stretches) {
        const CornerVectors scaled =
            keep_lengths_in_world(scene, hit.instance, hit.time, {{n[0], n[1], n[2]}});
        for (int k = 0; k < 3; ++k)
            n[k] = scaled.at[k];
    }
    g.normal = select(smooth, normalize(weighted(g, n)), g.ng);
}

/// Fills `g` in place because copies are slow.
template <HitUse use>
OBSCURA_INLINE void find_geometry(const SceneView& scene, const HitLanes& hit, HitGeometry& g) {
    g.has_shapes = false;
    g.primitive = {scene.primitives, hit.primitive};
    g.material = {scene.materials, g.primitive.integer<&Primitive::material>()};
    g.one_triangle = g.primitive.shared() && all(hit.triangle == LanesI(first_lane(hit.triangle)));
    LanesI index_word =
        (g.primitive.integer<&Primitive::first_triangle>() + hit.triangle) * LanesI(3);
    if (scene.shapes != nullptr) {
        g.shapes = g.primitive.integer<&Primitive::geometry>() != LanesI(0);
        g.has_shapes = any(g.shapes);
        index_word = select(g.shapes, LanesI(0), index_word);  // any triangle: result is unused
    }
    const Four<LanesI> corners = gather4<Lanes>(scene.indices, index_word);
    g.corner[0] = corners.x;
    g.corner[1] = corners.y;
    g.corner[2] = corners.z;
    Vec3<Lanes> p[3];
    for (int k = 0; k < 3; ++k) {
        if (g.has_shapes) g.corner[k] = select(g.shapes, LanesI(0), g.corner[k]);
        p[k] = read_corner3(scene.positions, g.corner[k] * LanesI(3), g.one_triangle);
    }
    if (scene.motion.positions != nullptr) {
        const CornerVectors moved = moved_corners(
            scene, scene.motion.positions, {g.primitive, g.corner, hit.time}, {{p[0], p[1], p[2]}});
        for (int k = 0; k < 3; ++k)
            p[k] = moved.at[k];
    }
    g.weight[0] = Lanes(1.0f) - hit.u - hit.v;
    g.weight[1] = hit.u;
    g.weight[2] = hit.v;
    g.position = weighted(g, p);
    set_face(scene.edge_scale, p, g);
    g.normal = g.ng;
    g.smooth_shift = splat3(Lanes(0.0f));
    interpolate_normal<use>(scene, hit, p, g);
    g.offset = use == HitUse::start_rays ? rounding_offset(g, p) : Lanes(0.0f);
}

/// Moves the lanes that hit an instance from object space to world space.
OBSCURA_INLINE void instance_to_world(const SceneView& scene, const HitLanes& hit, HitGeometry& g) {
    const Mask instanced = hit.instance >= LanesI(0);
    if (none(instanced)) return;
    const InstanceMaps maps = instance_maps(scene, hit.instance, hit.time);
    const Affine<Lanes>& world = maps.world_from_object;
    const Affine<Lanes>& object = maps.object_from_world;
    const Vec3<Lanes> position = transform_point(world, g.position);
    const Vec3<Lanes> normal_scaled = transform_normal(object, g.ng);
    const Vec3<Lanes> ng = normalize(normal_scaled);
    // area' = area * |det| * |M^-T n|
    const Lanes area_scale = abs(determinant(world)) * length(normal_scaled);
    Vec3<Lanes> magnitude;  // |M| |p| + |translation|: what the sums below round against
    const Vec3<Lanes> p = abs(g.position);
    const auto row_size = [&](int r) {
        return abs(world.m[r][0]) * p.x + abs(world.m[r][1]) * p.y + abs(world.m[r][2]) * p.z +
               abs(world.m[r][3]);
    };
    magnitude = {row_size(0), row_size(1), row_size(2)};
    const auto column_length = [&](int c) {
        return length(Vec3<Lanes>{world.m[0][c], world.m[1][c], world.m[2][c]});
    };
    const Lanes stretch = column_length(0) + column_length(1) + column_length(2);
    const Lanes offset = g.offset * stretch + Lanes(32.0f / 16777216.0f) * dot(abs(ng), magnitude);
    g.normal = select(instanced, normalize(transform_normal(object, g.normal)), g.normal);
    g.smooth_shift = select(instanced, transform_vector(world, g.smooth_shift), g.smooth_shift);
    g.position = select(instanced, position, g.position);
    g.ng = select(instanced, ng, g.ng);
    g.offset = select(instanced, offset, g.offset);
    g.area2 = select(instanced, g.area2 * area_scale, g.area2);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
