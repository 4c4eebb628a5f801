// accel/traversal_cost.cpp - how many primitives a ray is tested against, counted by callbacks.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/safe_ray.h"
#include "shape/triangle.h"

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

/// Corners of one triangle, in the primitive's space.
Triangle<float> read_corners(const CountedTriangles& triangles, unsigned number) {
    const Scene& scene = *triangles.impl->scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(triangles.primitive)];
    const uint32_t* corners =
        &scene.indices[3 * (static_cast<size_t>(primitive.first_triangle) + number)];
    const auto at = [&](int k) {
        const float* p = &scene.positions[3 * static_cast<size_t>(corners[k])];
        return Vec3f{p[0], p[1], p[2]};
    };
    return {at(0), at(1), at(2)};
}

void triangle_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& triangles = *static_cast<const CountedTriangles*>(args->geometryUserPtr);
    const Triangle<float> t = read_corners(triangles, args->primID);
    const Vec3f high = max3(t.a, max3(t.b, t.c));
    const Vec3f low = -max3(-t.a, max3(-t.b, -t.c));
    *args->bounds_o = {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

/// True when the ray stops at the hit: neither a hidden back nor a hole.
bool counts_as_hit(const CountedTriangles& triangles,
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
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    CountingContext& context = counting_context(args);
    const auto& triangles = *static_cast<const CountedTriangles*>(args->geometryUserPtr);
    const Triangle<float> triangle = read_corners(triangles, args->primID);
    const Vec3f ng = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        ++context.tests;
        const ShapeRay<float> ray{
            {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
            {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)}};
        const TriangleHit<float> hit = intersect_triangle(triangle, ray);
        const bool within = hit.t > RTCRayN_tnear(rays, n, i) && hit.t <= RTCRayN_tfar(rays, n, i);
        if (!hit.hit || !within) continue;
        const AlphaPlace place{
            RTCRayN_id(rays, n, i), context.common.embree.instID[0], args->primID};
        const bool from_behind = dot(ng, ray.direction) > 0.0f;
        if (!counts_as_hit(triangles, context.common, place, from_behind, {hit.beta, hit.gamma})) {
            continue;
        }
        RTCRayN_tfar(rays, n, i) = hit.t;
        RTCHitN_Ng_x(hits, n, i) = ng.x;
        RTCHitN_Ng_y(hits, n, i) = ng.y;
        RTCHitN_Ng_z(hits, n, i) = ng.z;
        RTCHitN_u(hits, n, i) = hit.beta;
        RTCHitN_v(hits, n, i) = hit.gamma;
        RTCHitN_primID(hits, n, i) = args->primID;
        RTCHitN_geomID(hits, n, i) = args->geomID;
        copy_instance_stack(context.common, hits, n, i);
    }
}

}  // namespace

RTCGeometry make_counted_triangles(Accel::Impl& impl, int32_t primitive_index) {
    const auto row = static_cast<size_t>(primitive_index);
    impl.counted[row] = {&impl, primitive_index};
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(
        geometry, static_cast<unsigned>(impl.scene->primitives[row].triangle_count));
    rtcSetGeometryUserData(geometry, &impl.counted[row]);
    rtcSetGeometryBoundsFunction(geometry, triangle_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_counted_triangle);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    return geometry;
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
