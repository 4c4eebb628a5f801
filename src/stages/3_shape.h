// stages/3_shape.h - the shading geometry of analytic shapes, rebuilt from the ray and the shape.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_motion.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// What shading wants to know of the lanes that hit shapes, in world space.
struct ShapeLanes {
    Vec3<Lanes> position, normal;
    Vec3<Lanes> dpdu, dpdv;
    Vec2<Lanes> uv;
    Lanes offset;  ///< distance along the normal at which rays start clear of the shape
};

/// Where and on what the lanes hit; copies, so that the caller's own stay in registers.
struct ShapeQuery {
    Mask shapes;        ///< other lanes get anything
    LanesI first, row;  ///< first row of the primitive, row within it
    LanesI geometry;    ///< GeometryKind
    LanesI instance;
    Vec3<Lanes> origin, direction;
    Lanes t;
    Lanes time;
};

/// A table's row as ShapeRow's words; particles lie in blocks and know no other kind.
class ShapeWords {
public:
    OBSCURA_INLINE ShapeWords(const SceneView& scene, const ShapeQuery& q) {
        const LanesI row = q.first + q.row;
        particles_ = q.geometry == LanesI(static_cast<int32_t>(GeometryKind::spheres));
        if (scene.spheres != nullptr && any(particles_)) {
            const LanesI word = select(particles_, sphere_word(row), LanesI(0));
            for (int i = 0; i < 4; ++i)
                sphere_[i] = gather<Lanes>(scene.spheres + i * sphere_block, word);
            has_particles_ = true;
        }
        const LanesI none(0);
        row_ = {scene.shapes, select(q.shapes & (!particles_), row, none), shape_words};
    }

    OBSCURA_INLINE LanesI kind() const {
        return select(particles_, LanesI(static_cast<int32_t>(ShapeKind::sphere)), row_.integer(0));
    }
    OBSCURA_INLINE Lanes operator()(int word) const {
        const Lanes from_row = row_.number(word);
        if (!has_particles_ || word > 4) return from_row;
        return select(particles_, sphere_[word - 1], from_row);
    }

private:
    TableRow<Lanes> row_;
    Lanes sphere_[4];
    Mask particles_;
    bool has_particles_ = false;
};

/// The hit point, brought onto the shape, with its normal and parametrisation.
///
/// In      q: rays in world space; at least one lane of q.shapes
/// Out     out: lanes of q.shapes
/// Source  shape/shape_row.h; offset: as for triangles in 3_surface.h
inline __attribute__((noinline)) void find_shape_lanes(const SceneView& scene,
                                                       const ShapeQuery& q,
                                                       ShapeLanes& out) {
    const ShapeWords words(scene, q);
    const Mask instanced = q.shapes & (q.instance >= LanesI(0));
    ShapeRay<Lanes> ray{q.origin, q.direction};
    InstanceMaps maps;
    const Affine<Lanes>& world = maps.world_from_object;
    const Affine<Lanes>& object = maps.object_from_world;
    if (any(instanced)) {
        maps = instance_maps(scene, q.instance, q.time);
        ray.origin = select(instanced, transform_point(object, q.origin), q.origin);
        ray.direction = select(instanced, transform_vector(object, q.direction), q.direction);
    }
    const Vec3<Lanes> at{multiply_add(q.t, ray.direction.x, ray.origin.x),
                         multiply_add(q.t, ray.direction.y, ray.origin.y),
                         multiply_add(q.t, ray.direction.z, ray.origin.z)};
    const SurfacePoint<Lanes> s = surface_of_shape<Lanes>(words.kind(), words, at);
    constexpr float steps = 32.0f / 16777216.0f;
    const Vec3<Lanes> half{words(4), words(5), words(6)};
    const Lanes extent = min(max_component(abs(half)), max_component(abs(s.position)));
    out = {s.position, s.normal, s.dpdu, s.dpdv, s.uv, s.error * Lanes(4.0f)};
    out.offset =
        out.offset + Lanes(steps) * (dot(abs(s.normal), abs(s.position)) + extent * Lanes(0.25f));
    if (none(instanced)) return;
    const Vec3<Lanes> p = abs(s.position);
    const auto row_size = [&](int r) {
        return abs(world.m[r][0]) * p.x + abs(world.m[r][1]) * p.y + abs(world.m[r][2]) * p.z +
               abs(world.m[r][3]);
    };
    const auto column_length = [&](int c) {
        return length(Vec3<Lanes>{world.m[0][c], world.m[1][c], world.m[2][c]});
    };
    const Vec3<Lanes> size{row_size(0), row_size(1), row_size(2)};
    const Vec3<Lanes> n = normalize(transform_normal(object, s.normal));
    const Lanes stretch = max(column_length(0), max(column_length(1), column_length(2)));
    const Lanes offset = out.offset * stretch + Lanes(steps) * dot(abs(n), size);
    out.position = select(instanced, transform_point(world, s.position), out.position);
    out.normal = select(instanced, n, out.normal);
    out.dpdu = select(instanced, transform_vector(world, s.dpdu), out.dpdu);
    out.dpdv = select(instanced, transform_vector(world, s.dpdv), out.dpdv);
    out.offset = select(instanced, offset, out.offset);
}

/// Puts the lanes that hit analytic shapes in place of what was read as triangles. Geometry: the
/// HitGeometry of 3_surface.h.
template <typename Geometry>
OBSCURA_INLINE void shapes_to_world(const SceneView& scene,
                                    const HitLanes& hit,
                                    const PathLanes& path,
                                    Geometry& g) {
    if (!g.has_shapes) return;
    const ShapeQuery query{g.shapes,
                           g.primitive.integer(0),
                           hit.triangle,
                           g.primitive.integer(16),
                           hit.instance,
                           path.origin,
                           path.direction,
                           hit.t,
                           hit.time};
    ShapeLanes s;
    find_shape_lanes(scene, query, s);
    const Mask m = g.shapes;
    g.position = select(m, s.position, g.position);
    g.ng = select(m, s.normal, g.ng);
    g.normal = select(m, s.normal, g.normal);
    g.offset = select(m, s.offset, g.offset);
    g.smooth_shift = select(m, splat3(Lanes(0.0f)), g.smooth_shift);
    // Texture space is stretched as the parametrisation is: one unit of it covers this area.
    g.area2 = select(m, length(cross(s.dpdu, s.dpdv)), g.area2);
    g.first_uv.base = select(m, LanesI(0), g.first_uv.base);
    g.first_uv.at = {select(m, s.uv.x, g.first_uv.at.x), select(m, s.uv.y, g.first_uv.at.y)};
    g.first_uv.area2 = select(m, Lanes(1.0f), g.first_uv.area2);
    g.dpdu = s.dpdu;
    g.dpdv = s.dpdv;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
