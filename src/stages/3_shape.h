// stages/3_shape.h - position, normal and derivatives at hits on analytic shapes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/segment.h"
#include "stages/3_motion.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Shading data of the lanes that hit shapes, in world space.
struct ShapeLanes {
    Vec3<Lanes> position, normal;
    Vec3<Lanes> dpdu, dpdv;
    Vec2<Lanes> uv;
    Lanes offset;  ///< distance along the normal at which rays start clear of the shape
    /// Of points and lines: the vertices on both sides, and the interpolation weight of the second.
    LanesI vertex, next_vertex;
    Lanes fraction;
};

/// The shapes that the lanes hit; copies, so that the caller's own values stay in registers.
struct ShapeQuery {
    Mask shapes;          ///< other lanes get anything
    LanesI first, index;  ///< of the primitive's first element, and within it
    LanesI geometry;      ///< GeometryKind
    LanesI normals;       ///< as Primitive::normal_base: points and lines may have them
    LanesI instance;
    Vec3<Lanes> origin, direction;
    Lanes t;
    Lanes time;
};

/// The lanes that hit curve segments, each in its segment's own frame.
struct CurveLanes {
    bool any = false;
    Mask lanes;
    LanesI first_point;
    SegmentFrame<Lanes> frame;
};

OBSCURA_INLINE CurveLanes read_curves(const SceneView& scene, Mask lanes, LanesI index) {
    CurveLanes out;
    if (scene.curve_points == nullptr || none(lanes)) return out;
    out.any = true;
    out.lanes = lanes;
    const LanesI none(0);
    out.first_point = gather<Lanes>(scene.curve_segments, select(lanes, index, none));
    const Four<Lanes> from = gather4<Lanes>(scene.curve_points, out.first_point * LanesI(4));
    const Four<Lanes> to = gather4<Lanes>(scene.curve_points + 4, out.first_point * LanesI(4));
    out.frame = frame_of<Lanes>({{from.x, from.y, from.z}, {to.x, to.y, to.z}, from.w, to.w});
    return out;
}

/// Transforms a surface point from the curve segment's frame back to the frame of the curve.
OBSCURA_INLINE void leave_frame(const CurveLanes& curves, SurfacePoint<Lanes>& s) {
    const SegmentFrame<Lanes>& frame = curves.frame;
    const Mask m = curves.lanes;
    s.position = select(m, frame.centre + out_of_frame(frame, s.position), s.position);
    s.normal = select(m, out_of_frame(frame, s.normal), s.normal);
    s.dpdu = select(m, out_of_frame(frame, s.dpdu), s.dpdu);
    s.dpdv = select(m, out_of_frame(frame, s.dpdv), s.dpdv);
}

/// How far off a curve segment Embree may report hits: it subtracts squares as large as that of
/// half the segment's length, and their rounding shifts the radius.
OBSCURA_INLINE Lanes curve_slack(const CurveLanes& curves) {
    constexpr float rounding = 4.0f / 4194304.0f;
    const Capsule<Lanes>& capsule = curves.frame.capsule;
    const Lanes thin = max(min(capsule.bottom, capsule.top), capsule.half_height * Lanes(1e-3f));
    const Lanes slack = square(capsule.half_height) / thin * Lanes(rounding);
    return select(curves.lanes, slack, Lanes(0.0f));
}

/// Reads any shape as the members of a ShapeRecord: particles are spheres stored in blocks, and
/// curve segments are capsules around their own origin.
class ShapeWords {
public:
    OBSCURA_INLINE ShapeWords(const SceneView& scene, const ShapeQuery& q) {
        const LanesI index = q.first + q.index;
        const Mask lines = q.geometry == LanesI(static_cast<int32_t>(GeometryKind::curves));
        curves_ = read_curves(scene, q.shapes & lines, index);
        particles_ = q.geometry == LanesI(static_cast<int32_t>(GeometryKind::spheres));
        if (scene.spheres != nullptr && any(particles_)) {
            const LanesI word = select(particles_, sphere_word(index), LanesI(0));
            for (int i = 0; i < 4; ++i)
                sphere_[i] = gather<Lanes>(scene.spheres + i * sphere_block, word);
            has_particles_ = true;
        }
        const LanesI none(0);
        record_ = {scene.shapes, select(q.shapes & (!(particles_ | lines)), index, none)};
    }

    OBSCURA_INLINE LanesI kind() const {
        const LanesI sphere(static_cast<int32_t>(ShapeKind::sphere));
        const LanesI own = select(particles_, sphere, record_.integer<&ShapeRecord::kind>());
        if (!curves_.any) return own;
        return select(curves_.lanes, LanesI(static_cast<int32_t>(ShapeKind::capsule)), own);
    }
    template <auto member>
    OBSCURA_INLINE Lanes number(int element) const {
        Lanes value = record_.number<member>(element);
        if (has_particles_) {  // centre and radius
            constexpr bool is_centre = same_member<member, &ShapeRecord::centre>;
            if (is_centre) value = select(particles_, sphere_[element], value);
            if (same_member<member, &ShapeRecord::size> && element == 0) {
                value = select(particles_, sphere_[3], value);
            }
        }
        if (curves_.any) {
            const bool is_size = same_member<member, &ShapeRecord::size>;
            value = select(curves_.lanes, is_size ? capsule_size(element) : Lanes(0.0f), value);
        }
        return value;
    }
    OBSCURA_INLINE const CurveLanes& curves() const { return curves_; }

private:
    OBSCURA_INLINE Lanes capsule_size(int element) const {
        const Capsule<Lanes>& capsule = curves_.frame.capsule;
        if (element == 0) return capsule.half_height;
        return element == 1 ? capsule.bottom : capsule.top;
    }

    CurveLanes curves_;
    TableRecord<Lanes, ShapeRecord> record_;
    Lanes sphere_[4];
    Mask particles_;
    bool has_particles_ = false;
};

/// Finds the vertices whose colours are interpolated.
///
/// In   position: in the segment's frame, for lanes that hit curves
OBSCURA_INLINE void find_vertices(const ShapeQuery& q,
                                  const CurveLanes& curves,
                                  const Vec3<Lanes>& position,
                                  ShapeLanes& out) {
    out.vertex = q.first + q.index;
    out.next_vertex = out.vertex;
    out.fraction = Lanes(0.0f);
    if (!curves.any) return;
    const Lanes fraction = fraction_along(curves.frame, position.y);
    out.vertex = select(curves.lanes, curves.first_point, out.vertex);
    out.next_vertex = select(curves.lanes, curves.first_point + LanesI(1), out.next_vertex);
    out.fraction = select(curves.lanes, fraction, out.fraction);
}

/// Shades points and lines that have vertex normals as small flat surfaces through their centre,
/// with that normal, from all sides; rays start outside the round surface. A normal along the line
/// is ignored.
///
/// In   s: in the primitive's own space; out: with the vertices
/// Source  glTF 2.0, Point and Line Materials
inline __attribute__((noinline)) void orient_points_lines(const SceneView& scene,
                                                          const ShapeQuery& q,
                                                          const ShapeWords& words,
                                                          SurfacePoint<Lanes>& s,
                                                          ShapeLanes& out) {
    const Mask has_normals = q.shapes & (q.normals != LanesI(no_attribute));
    const auto normal_of = [&](LanesI vertex) {
        return gather3(scene.attributes,
                       select(has_normals, q.normals + vertex * LanesI(3), LanesI(0)));
    };
    const Vec3<Lanes> first = normal_of(out.vertex);
    const Vec3<Lanes> next = normal_of(out.next_vertex);
    Vec3<Lanes> n = first + (next - first) * out.fraction;
    const Lanes size = length(n);
    Mask turns = has_normals & (size > Lanes(1e-6f));
    n = n * (Lanes(1.0f) / max(size, Lanes(1e-6f)));
    Vec3<Lanes> centre = shape_centre<Lanes>(words);
    Lanes radius = words.number<&ShapeRecord::size>(0);
    const CurveLanes& curves = words.curves();
    if (curves.any) {
        const Capsule<Lanes>& capsule = curves.frame.capsule;
        const Vec3<Lanes> axis = curves.frame.axes.normal;
        const Lanes height = capsule.half_height * (out.fraction + out.fraction - Lanes(1.0f));
        centre = select(curves.lanes, curves.frame.centre + axis * height, centre);
        // The more the normal leans along the line, the further it is to the outside.
        const Lanes width = length(n - axis * dot(n, axis));
        const Lanes thickness = capsule.bottom + (capsule.top - capsule.bottom) * out.fraction;
        radius = select(curves.lanes, thickness / max(width, Lanes(0.1f)), radius);
        turns = turns & (!(curves.lanes & (width < Lanes(0.1f))));
    }
    s.position = select(turns, centre, s.position);
    s.normal = select(turns, n, s.normal);
    out.offset = select(turns, radius, out.offset);
}

/// The hit point, brought onto the shape, with its normal and parametrisation.
///
/// In      q: rays in world space; at least one lane of q.shapes
/// Out     out: lanes of q.shapes
/// Source  shape/shape_record.h; offset: as for triangles in 3_geometry.h
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
    Vec3<Lanes> at{multiply_add(q.t, ray.direction.x, ray.origin.x),
                   multiply_add(q.t, ray.direction.y, ray.origin.y),
                   multiply_add(q.t, ray.direction.z, ray.origin.z)};
    const CurveLanes& curves = words.curves();
    if (curves.any) {
        at = select(curves.lanes, into_frame(curves.frame, at - curves.frame.centre), at);
    }
    SurfacePoint<Lanes> s = surface_of_shape<Lanes>(words.kind(), words, at);
    find_vertices(q, curves, s.position, out);
    if (curves.any) leave_frame(curves, s);
    out.offset = Lanes(0.0f);
    if (any(q.shapes & (q.normals != LanesI(no_attribute))))
        orient_points_lines(scene, q, words, s, out);
    constexpr float steps = 32.0f / 16777216.0f;
    const Vec3<Lanes> half = shape_size<Lanes>(words);
    const Lanes extent = min(max_component(abs(half)), max_component(abs(s.position)));
    out.position = s.position;
    out.normal = s.normal;
    out.dpdu = s.dpdu;
    out.dpdv = s.dpdv;
    out.uv = s.uv;
    out.offset = out.offset + s.error * Lanes(4.0f) +
                 Lanes(steps) * (dot(abs(s.normal), abs(s.position)) + extent * Lanes(0.25f));
    if (curves.any) out.offset = out.offset + curve_slack(curves);
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

/// Replaces the triangle geometry of lanes that hit analytic shapes. Geometry: the HitGeometry of
/// 3_geometry.h.
template <typename Geometry>
OBSCURA_INLINE void shapes_to_world(const SceneView& scene,
                                    const HitLanes& hit,
                                    const PathLanes& path,
                                    Geometry& g) {
    if (!g.has_shapes) return;
    const ShapeQuery query{g.shapes,
                           g.primitive.template integer<&Primitive::first_triangle>(),
                           hit.triangle,
                           g.primitive.template integer<&Primitive::geometry>(),
                           g.primitive.template integer<&Primitive::normal_base>(),
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
    // One unit of texture space covers this area.
    g.area2 = select(m, length(cross(s.dpdu, s.dpdv)), g.area2);
    g.first_uv.base = select(m, LanesI(0), g.first_uv.base);
    g.first_uv.at = {select(m, s.uv.x, g.first_uv.at.x), select(m, s.uv.y, g.first_uv.at.y)};
    g.first_uv.area2 = select(m, Lanes(1.0f), g.first_uv.area2);
    g.dpdu = s.dpdu;
    g.dpdv = s.dpdv;
    // Among shapes, only points and lines have vertex colours, vertex texture coordinates and no
    // tangents: their vertices serve as the corners.
    const LanesI tangents = g.primitive.template integer<&Primitive::tangent_base>();
    const Mask points_lines = m & (tangents == LanesI(no_attribute));
    if (none(points_lines)) return;
    g.corner[0] = select(points_lines, s.vertex, g.corner[0]);
    g.corner[1] = select(points_lines, s.next_vertex, g.corner[1]);
    g.corner[2] = select(points_lines, s.vertex, g.corner[2]);
    g.weight[0] = select(points_lines, Lanes(1.0f) - s.fraction, g.weight[0]);
    g.weight[1] = select(points_lines, s.fraction, g.weight[1]);
    g.weight[2] = select(points_lines, Lanes(0.0f), g.weight[2]);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
