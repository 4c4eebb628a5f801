// shape/shape_record.h - the record of an analytic shape, and its formulas by kind.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/box.h"
#include "shape/capsule.h"
#include "shape/disk.h"
#include "shape/frustum.h"
#include "shape/plane.h"
#include "shape/quadric.h"
#include "shape/sphere.h"

#include <cstddef>
#include <cstdint>

namespace obscura {

/// To add one: a header with its formulas; a name here; its reader, a case in intersect_shape,
/// is_front and surface_of_shape below and in half_extent of shape/shape_record.cpp; its members in
/// gltf/parse/document_shapes.cpp and in README.md and schema of docs/extensions/OBSCURA_shape. The
/// compiler names the switches in crosscheck/ and explain/. Tests in tests/shape, tests/crosscheck.
enum class ShapeKind : int32_t {
    sphere,
    box,
    frustum,  ///< cylinders and cones
    capsule,
    plane,  ///< finite or not
    disk,
    quadric,
    quadric_from_above,  ///< the same surface with another parametrisation
};

/// One shape in its primitive's space, 32-bit words only; metres.
struct ShapeRecord {
    int32_t kind = 0;  ///< ShapeKind
    float centre[3] = {0, 0, 0};
    /// sphere: radius; box, quadric: half edges; frustum, capsule: half height, radius at the
    /// bottom and at the top; plane: half edges along X and Z; disk: outer and inner radius
    float size[3] = {1, 1, 1};
    float k[10] = {};  ///< quadric: coefficients relative to the centre
};

static_assert(sizeof(ShapeRecord) == 17 * 4, "read as 32-bit words: no padding");

/// A box around a shape, enlarged for rounding; infinite for infinite planes.
struct ShapeBox {
    Vec3f low, high;
};
ShapeBox shape_bounds(const ShapeRecord& record);

/// The box around the spheres of a block: see sphere_block.h.
ShapeBox sphere_block_bounds(const float* block);

/// The shape after a uniform scale about the origin and a translation.
ShapeRecord scaled_and_moved(const ShapeRecord& record, double scale, const Vec3d& move);

inline bool is_unbounded(const ShapeRecord& record) {
    return record.kind == static_cast<int32_t>(ShapeKind::plane) &&
           (record.size[0] >= unbounded || record.size[1] >= unbounded);
}

inline namespace OBSCURA_ISA {

/// The numbers of one shape, the same for all lanes.
template <typename F>
class UniformShape {
public:
    OBSCURA_INLINE explicit UniformShape(const ShapeRecord& record) : record_(record) {}
    template <auto member>
    OBSCURA_INLINE F number(int element) const {
        return F((record_.*member)[element]);
    }

private:
    const ShapeRecord& record_;
};

// The shapes' own structs from a record's numbers, which `read` returns.
template <typename F, typename Read>
OBSCURA_INLINE F shape_size(const Read& read, int element) {
    return read.template number<&ShapeRecord::size>(element);
}
template <typename F, typename Read>
OBSCURA_INLINE Vec3<F> shape_size(const Read& read) {
    return {shape_size<F>(read, 0), shape_size<F>(read, 1), shape_size<F>(read, 2)};
}
template <typename F, typename Read>
OBSCURA_INLINE Vec3<F> shape_centre(const Read& read) {
    const auto number = [&](int k) { return read.template number<&ShapeRecord::centre>(k); };
    return {number(0), number(1), number(2)};
}
template <typename F, typename Read>
OBSCURA_INLINE Sphere<F> read_sphere(const Read& read) {
    return {shape_centre<F>(read), shape_size<F>(read, 0)};
}
template <typename F, typename Read>
OBSCURA_INLINE AlignedBox<F> read_box(const Read& read) {
    return {shape_centre<F>(read), shape_size<F>(read)};
}
template <typename F, typename Read>
OBSCURA_INLINE Frustum<F> read_frustum(const Read& read) {
    const Vec3<F> size = shape_size<F>(read);
    return {shape_centre<F>(read), size.x, size.y, size.z};
}
template <typename F, typename Read>
OBSCURA_INLINE Capsule<F> read_capsule(const Read& read) {
    const Vec3<F> size = shape_size<F>(read);
    return {shape_centre<F>(read), size.x, size.y, size.z};
}
template <typename F, typename Read>
OBSCURA_INLINE Plane<F> read_plane(const Read& read) {
    return {shape_centre<F>(read), shape_size<F>(read, 0), shape_size<F>(read, 1)};
}
template <typename F, typename Read>
OBSCURA_INLINE Disk<F> read_disk(const Read& read) {
    return {shape_centre<F>(read), shape_size<F>(read, 0), shape_size<F>(read, 1)};
}
template <typename F, typename Read>
OBSCURA_INLINE Quadric<F> read_quadric(const Read& read) {
    Quadric<F> q{shape_centre<F>(read), shape_size<F>(read), {}};
    for (int i = 0; i < 10; ++i)
        q.k[i] = read.template number<&ShapeRecord::k>(i);
    return q;
}

/// Both intersections of a line with one shape.
///
/// In      ray: in the shape's space, metres; finite, with a direction
/// Out     see Roots
/// Source  the headers of the shapes
template <typename F>
OBSCURA_INLINE Roots<F> intersect_shape(const ShapeRecord& record, const ShapeRay<F>& ray) {
    const UniformShape<F> read(record);
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            return intersect_sphere(read_sphere<F>(read), ray);
        case ShapeKind::box:
            return intersect_box(read_box<F>(read), ray);
        case ShapeKind::frustum:
            return intersect_frustum(read_frustum<F>(read), ray);
        case ShapeKind::capsule:
            return intersect_capsule(read_capsule<F>(read), ray);
        case ShapeKind::plane:
            return intersect_plane(read_plane<F>(read), ray);
        case ShapeKind::disk:
            return intersect_disk(read_disk<F>(read), ray);
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return intersect_quadric(read_quadric<F>(read), ray);
}

/// True where the ray hits the front at root k of intersect_shape: the outside of solid shapes, the
/// upper side of flat ones, the positive side of a quadric.
template <typename F>
OBSCURA_INLINE MaskOf<F> is_front(const ShapeRecord& record,
                                  const ShapeRay<F>& ray,
                                  const F& t,
                                  int k) {
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::plane:
        case ShapeKind::disk:
            return ray.direction.y < F(0.0f);
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
        default:
            return MaskOf<F>(k == 0);
    }
    const Quadric<F> q = read_quadric<F>(UniformShape<F>(record));
    return falls_along(q, ray, t);
}

/// The point of a shape nearest to a given point close to it; every lane has its own shape.
///
/// In      kind: ShapeKind; read: numbers of ShapeRecord; at: in the shape's space, metres
template <typename F, typename Read>
OBSCURA_INLINE SurfacePoint<F> surface_of_shape(const IntOf<F>& kind,
                                                const Read& read,
                                                const Vec3<F>& at) {
    const Vec3<F> centre = shape_centre<F>(read);
    const Vec3<F> near = at - centre;
    const auto is = [&](ShapeKind wanted) {
        return kind == IntOf<F>(static_cast<int32_t>(wanted));
    };
    const auto above = is(ShapeKind::quadric_from_above);
    SurfacePoint<F> out = surface_of_sphere(read_sphere<F>(read), near);
    if (any(is(ShapeKind::box))) {
        choose(out, is(ShapeKind::box), surface_of_box(read_box<F>(read), near));
    }
    if (any(is(ShapeKind::frustum))) {
        choose(out, is(ShapeKind::frustum), surface_of_frustum(read_frustum<F>(read), near));
    }
    if (any(is(ShapeKind::capsule))) {
        choose(out, is(ShapeKind::capsule), surface_of_capsule(read_capsule<F>(read), near));
    }
    if (any(is(ShapeKind::plane))) {
        choose(out, is(ShapeKind::plane), surface_of_plane(read_plane<F>(read), near));
    }
    if (any(is(ShapeKind::disk))) {
        choose(out, is(ShapeKind::disk), surface_of_disk(read_disk<F>(read), near));
    }
    if (any(is(ShapeKind::quadric) | above)) {
        choose(out,
               is(ShapeKind::quadric) | above,
               surface_of_quadric(read_quadric<F>(read), above, near));
    }
    // Adding the centre back rounds too.
    const Vec3<F> size = abs(centre) + abs(out.position);
    out.error = out.error + dot(abs(out.normal), size) * F(surface_slack);
    out.position = out.position + centre;
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
