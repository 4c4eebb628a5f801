// accel/traversal_cost.cpp - counts the primitives that a ray is tested against.
// SPDX-License-Identifier: Apache-2.0
#include "accel/safe_ray.h"
#include "accel/user_elements.h"
#include "shape/segment.h"

namespace obscura {

namespace {

/// Context of a query that counts tests. `common` must come first.
struct CountingContext {
    QueryContext common;
    const ShapeCallbacks* shapes = nullptr;
    unsigned tests = 0;
};

template <typename Arguments>
CountingContext& counting_context(const Arguments* args) {
    return *reinterpret_cast<CountingContext*>(args->context);
}

/// True when the ray stops at the hit: neither a culled back face nor an alpha cut-out.
bool counts_as_hit(const UserElements& triangles,
                   const QueryContext& context,
                   const AlphaCandidate& candidate,
                   bool from_behind,
                   Vec2f barycentric) {
    const auto index = static_cast<size_t>(triangles.primitive);
    const Accel::Impl& impl = *triangles.impl;
    if (from_behind && impl.single_sided[index] != 0) return false;
    const Primitive& primitive = impl.scene->primitives[index];
    if (!needs_alpha_filter(*impl.scene, primitive, impl.materials_with_holes)) return true;
    return is_opaque_there(
        {impl.scene, impl.textures, triangles.primitive}, context, candidate, barycentric);
}

ShapeRay<float> read_ray(RTCRayN* rays, unsigned n, unsigned i) {
    return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
            {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)}};
}

/// Embree's callback; rays come one at a time because count_tests traces single rays.
void intersect_counted_triangle(const RTCIntersectFunctionNArguments* args) {
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    CountingContext& context = counting_context(args);
    const auto& triangles = *static_cast<const UserElements*>(args->geometryUserPtr);
    const Triangle<float> triangle = read_corners(triangles, args->primID);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        ++context.tests;
        const TriangleHit<float> hit = meet(triangle, rays, n, i);
        if (!hit.hit) continue;
        const UserHit found = user_hit(triangle, hit);
        const AlphaCandidate candidate{
            RTCRayN_id(rays, n, i), context.common.embree.instID[0], args->primID};
        const bool from_behind = dot(found.ng, read_ray(rays, n, i).direction) > 0.0f;
        if (!counts_as_hit(triangles, context.common, candidate, from_behind, found.uv)) continue;
        write_hit(args, found, i);
    }
}

/// One curve segment, in world space.
Segment<float> read_segment(const UserElements& lines, unsigned number) {
    const Scene& scene = *lines.impl->scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(lines.primitive)];
    const size_t index = static_cast<size_t>(primitive.first_triangle) + number;
    const float* p = &scene.curve_points[4 * static_cast<size_t>(scene.curve_segments[index])];
    return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}, p[3], p[7]};
}

void segment_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& lines = *static_cast<const UserElements*>(args->geometryUserPtr);
    const Segment<float> s = read_segment(lines, args->primID);
    const Vec3f from = splat3(s.radius_from);
    const Vec3f to = splat3(s.radius_to);
    const Vec3f high = max3(s.from + from, s.to + to);
    const Vec3f low = -max3(from - s.from, to - s.to);
    *args->bounds_o = {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

/// As intersect_counted_triangle. Both sides of a line's surface count.
void intersect_counted_curve(const RTCIntersectFunctionNArguments* args) {
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    CountingContext& context = counting_context(args);
    const auto& lines = *static_cast<const UserElements*>(args->geometryUserPtr);
    const SegmentFrame<float> frame = frame_of(read_segment(lines, args->primID));
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        ++context.tests;
        const ShapeRay<float> ray = read_ray(rays, n, i);
        const NearHit<float> hit = nearest(
            intersect_segment(frame, ray), RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i));
        if (!hit.found) continue;
        const Vec3f own = into_frame(frame, ray.origin + ray.direction * hit.t - frame.centre);
        const Vec2f along{fraction_along(frame, own.y), 0.0f};
        const AlphaCandidate candidate{
            RTCRayN_id(rays, n, i), context.common.embree.instID[0], args->primID};
        if (!counts_as_hit(lines, context.common, candidate, false, along)) continue;
        write_hit(args, {hit.t, -ray.direction, along}, i);
    }
}

}  // namespace

RTCGeometry make_counted_triangles(Accel::Impl& impl, int32_t primitive_index) {
    return make_user_elements(
        impl, primitive_index, {triangle_bounds, intersect_counted_triangle, nullptr});
}

RTCGeometry make_counted_curves(Accel::Impl& impl, int32_t primitive_index) {
    return make_user_elements(
        impl, primitive_index, {segment_bounds, intersect_counted_curve, nullptr});
}

namespace {

/// Blocks of a cluster whose boxes the ray meets before its nearest hit so far.
unsigned entered_blocks(const RTCIntersectFunctionNArguments* args,
                        const ShapeGeometry& geometry,
                        unsigned i) {
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    const float* boxes = geometry.boxes + static_cast<size_t>(args->primID) * cluster_floats;
    const Span<float> limits{RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i)};
    const BoxEntries entries = enter_boxes(boxes, read_ray(rays, n, i), limits);
    return static_cast<unsigned>(__builtin_popcount(entries.bits));
}

}  // namespace

void intersect_counted_shape(const RTCIntersectFunctionNArguments* args) {
    CountingContext& context = counting_context(args);
    context.shapes->intersect(args);
    const auto& geometry = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        context.tests += geometry.records != nullptr ? 1U : entered_blocks(args, geometry, i);
    }
}

int Accel::count_tests(const RayColumns& rays, float* tests) const {
    CountingContext context;
    Query query(context.common, false);
    context.common.fixed_threshold = true;
    context.common.culls_back_faces = true;
    context.shapes = impl_->functions.shapes;
    int refused = 0;
    for (int index = 0; index < rays.count; ++index) {
        tests[index] = 0.0f;
        if (!is_safe(rays, index, impl_->reach)) {
            ++refused;
            continue;
        }
        RTCRayHit ray;
        load_ray(rays, index, ray.ray);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        // Infinite planes are not in the BVH: every ray is tested against each.
        context.tests = static_cast<unsigned>(impl_->infinite_planes.size());
        query.intersect1(impl_->top, &ray);
        tests[index] = static_cast<float>(context.tests);
    }
    return refused;
}

}  // namespace obscura
