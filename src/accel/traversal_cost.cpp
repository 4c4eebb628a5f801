// accel/traversal_cost.cpp - how many primitives a ray is tested against, counted by callbacks.
// SPDX-License-Identifier: Apache-2.0
#include "accel/safe_ray.h"
#include "accel/user_triangles.h"

namespace obscura {

namespace {

/// A query of one ray that counts. The common part must come first.
struct CountingContext {
    QueryContext common;
    const ShapeCallbacks* shapes = nullptr;
    unsigned tests = 0;
};

template <typename Arguments>
CountingContext& counting_context(const Arguments* args) {
    return *reinterpret_cast<CountingContext*>(args->context);
}

/// True when the ray stops at the hit: neither a hidden back nor a hole.
bool counts_as_hit(const UserTriangles& triangles,
                   const QueryContext& context,
                   const AlphaPlace& place,
                   bool from_behind,
                   Vec2f barycentric) {
    const auto row = static_cast<size_t>(triangles.primitive);
    const Accel::Impl& impl = *triangles.impl;
    if (from_behind && impl.single_sided[row] != 0) return false;
    const Primitive& primitive = impl.scene->primitives[row];
    if (!needs_alpha_filter(*impl.scene, primitive, impl.materials_with_holes)) return true;
    return is_opaque_there(
        {impl.scene, impl.textures, triangles.primitive}, context, place, barycentric);
}

/// Embree's callback; rays come one at a time, for count_tests asks so.
void intersect_counted_triangle(const RTCIntersectFunctionNArguments* args) {
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    CountingContext& context = counting_context(args);
    const auto& triangles = *static_cast<const UserTriangles*>(args->geometryUserPtr);
    const Triangle<float> triangle = read_corners(triangles, args->primID);
    const Vec3f ng = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        ++context.tests;
        const TriangleHit<float> hit = meet(triangle, rays, n, i);
        if (!hit.hit) continue;
        const AlphaPlace place{
            RTCRayN_id(rays, n, i), context.common.embree.instID[0], args->primID};
        const Vec3f direction{
            RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
        const bool from_behind = dot(ng, direction) > 0.0f;
        if (counts_as_hit(triangles, context.common, place, from_behind, {hit.beta, hit.gamma})) {
            write_hit(args, triangle, hit, i);
        }
    }
}

}  // namespace

RTCGeometry make_counted_triangles(Accel::Impl& impl, int32_t primitive) {
    return make_user_triangles(impl, primitive, {intersect_counted_triangle, nullptr});
}

void intersect_counted_shape(const RTCIntersectFunctionNArguments* args) {
    CountingContext& context = counting_context(args);
    for (unsigned i = 0; i < args->N; ++i)
        context.tests += args->valid[i] != 0 ? 1U : 0U;
    context.shapes->intersect(args);
}

int Accel::count_tests(const RayColumns& rays, float* tests) const {
    CountingContext context;
    Query query(context.common, false);
    context.common.fixed_threshold = true;
    context.common.culls_back_faces = true;
    context.shapes = impl_->shape_callbacks;
    int refused = 0;
    for (int row = 0; row < rays.count; ++row) {
        tests[row] = 0.0f;
        if (!is_safe(rays, row)) {
            ++refused;
            continue;
        }
        RTCRayHit ray;
        load_ray(rays, row, ray.ray);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        // Planes without end lie beside the hierarchy: every ray is tested against each.
        context.tests = static_cast<unsigned>(impl_->endless_planes.size());
        query.intersect1(impl_->top, &ray);
        tests[row] = static_cast<float>(context.tests);
    }
    return refused;
}

}  // namespace obscura
