// accel/user_elements.cpp - triangles and lines as Embree user geometry with our own callbacks.
// SPDX-License-Identifier: Apache-2.0
#include "accel/user_elements.h"

namespace obscura {

void triangle_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& triangles = *static_cast<const UserElements*>(args->geometryUserPtr);
    const Triangle<float> t = read_corners(triangles, args->primID);
    const Vec3f high = max3(t.a, max3(t.b, t.c));
    const Vec3f low = -max3(-t.a, max3(-t.b, -t.c));
    *args->bounds_o = {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

RTCGeometry make_user_elements(Accel::Impl& impl,
                               int32_t primitive,
                               const UserCallbacks& callbacks) {
    const auto index = static_cast<size_t>(primitive);
    impl.user_elements.resize(impl.scene->primitives.size());  // once: pointers stay
    impl.user_elements[index] = {&impl, primitive};
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(
        geometry, static_cast<unsigned>(impl.scene->primitives[index].triangle_count));
    rtcSetGeometryUserData(geometry, &impl.user_elements[index]);
    rtcSetGeometryBoundsFunction(geometry, callbacks.bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, callbacks.intersect);
    rtcSetGeometryOccludedFunction(geometry, callbacks.occluded);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    return geometry;
}

Triangle<float> read_corners(const UserElements& triangles, unsigned number) {
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

TriangleHit<float> meet(const Triangle<float>& triangle, RTCRayN* rays, unsigned n, unsigned i) {
    const ShapeRay<double> ray{
        {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
        {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)}};
    const auto exact = [](const Vec3f& p) { return Vec3d{p.x, p.y, p.z}; };
    const TriangleHit<double> found =
        intersect_triangle<double>({exact(triangle.a), exact(triangle.b), exact(triangle.c)}, ray);
    TriangleHit<float> hit{static_cast<float>(found.t),
                           static_cast<float>(found.beta),
                           static_cast<float>(found.gamma),
                           found.hit};
    hit.hit = hit.hit && hit.t > RTCRayN_tnear(rays, n, i) && hit.t <= RTCRayN_tfar(rays, n, i);
    return hit;
}

UserHit user_hit(const Triangle<float>& triangle, const TriangleHit<float>& hit) {
    const Vec3f ng = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    return {hit.t, ng, {hit.beta, hit.gamma}};
}

void write_hit(const RTCIntersectFunctionNArguments* args, const UserHit& hit, unsigned i) {
    const unsigned n = args->N;
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, n), n, i) = hit.t;
    RTCHitN_Ng_x(hits, n, i) = hit.ng.x;
    RTCHitN_Ng_y(hits, n, i) = hit.ng.y;
    RTCHitN_Ng_z(hits, n, i) = hit.ng.z;
    RTCHitN_u(hits, n, i) = hit.uv.x;
    RTCHitN_v(hits, n, i) = hit.uv.y;
    RTCHitN_primID(hits, n, i) = args->primID;
    RTCHitN_geomID(hits, n, i) = args->geomID;
    copy_instance_stack(*reinterpret_cast<const QueryContext*>(args->context), hits, n, i);
}

}  // namespace obscura
