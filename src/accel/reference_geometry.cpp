// accel/reference_geometry.cpp - triangles as user geometry, spheres as Embree's own primitive.
// SPDX-License-Identifier: Apache-2.0
#include "accel/reference_geometry.h"

#include "shape/triangle.h"

#include <algorithm>

namespace obscura {

namespace {

Vec3f corner_of(const Scene& scene, int32_t triangle, size_t corner) {
    const uint32_t vertex = scene.indices[static_cast<size_t>(triangle) * 3 + corner];
    const float* p = &scene.positions[3 * static_cast<size_t>(vertex)];
    return {p[0], p[1], p[2]};
}

Triangle<float> triangle_of(const UserTriangles& triangles, unsigned row) {
    const int32_t triangle = triangles.first_triangle + static_cast<int32_t>(row);
    return {corner_of(*triangles.scene, triangle, 0),
            corner_of(*triangles.scene, triangle, 1),
            corner_of(*triangles.scene, triangle, 2)};
}

void triangle_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& triangles = *static_cast<const UserTriangles*>(args->geometryUserPtr);
    const Triangle<float> t = triangle_of(triangles, args->primID);
    args->bounds_o->lower_x = std::min({t.a.x, t.b.x, t.c.x});
    args->bounds_o->lower_y = std::min({t.a.y, t.b.y, t.c.y});
    args->bounds_o->lower_z = std::min({t.a.z, t.b.z, t.c.z});
    args->bounds_o->upper_x = std::max({t.a.x, t.b.x, t.c.x});
    args->bounds_o->upper_y = std::max({t.a.y, t.b.y, t.c.y});
    args->bounds_o->upper_z = std::max({t.a.z, t.b.z, t.c.z});
}

TriangleHit<float> meet(const Triangle<float>& triangle, RTCRayN* rays, unsigned n, unsigned i) {
    const ShapeRay<float> ray{
        {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
        {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)}};
    TriangleHit<float> hit = intersect_triangle(triangle, ray);
    hit.hit = hit.hit && hit.t > RTCRayN_tnear(rays, n, i) && hit.t <= RTCRayN_tfar(rays, n, i);
    return hit;
}

void intersect_triangles(const RTCIntersectFunctionNArguments* args) {
    const auto& triangles = *static_cast<const UserTriangles*>(args->geometryUserPtr);
    const auto& context = *reinterpret_cast<const QueryContext*>(args->context);
    const Triangle<float> triangle = triangle_of(triangles, args->primID);
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    const Vec3f ng = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] == 0) continue;
        const TriangleHit<float> hit = meet(triangle, rays, n, i);
        if (!hit.hit) continue;
        RTCRayN_tfar(rays, n, i) = hit.t;
        RTCHitN_Ng_x(hits, n, i) = ng.x;
        RTCHitN_Ng_y(hits, n, i) = ng.y;
        RTCHitN_Ng_z(hits, n, i) = ng.z;
        RTCHitN_u(hits, n, i) = hit.beta;
        RTCHitN_v(hits, n, i) = hit.gamma;
        RTCHitN_primID(hits, n, i) = args->primID;
        RTCHitN_geomID(hits, n, i) = args->geomID;
        copy_instance_stack(context, hits, n, i);
    }
}

void occlude_triangles(const RTCOccludedFunctionNArguments* args) {
    const auto& triangles = *static_cast<const UserTriangles*>(args->geometryUserPtr);
    const Triangle<float> triangle = triangle_of(triangles, args->primID);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0 || !meet(triangle, args->ray, args->N, i).hit) continue;
        RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
    }
}

void finish(RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
}

}  // namespace

bool are_spheres(const Accel::Impl& impl, int32_t primitive) {
    const ShapeGeometry& shapes = impl.shapes[static_cast<size_t>(primitive)];
    return shapes.rows == nullptr || shapes.rows->kind == static_cast<int32_t>(ShapeKind::sphere);
}

RTCGeometry make_sphere_points(Accel::Impl& impl, int32_t primitive) {
    const ShapeGeometry& shapes = impl.shapes[static_cast<size_t>(primitive)];
    const auto count = static_cast<size_t>(shapes.count);
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
    for (size_t i = 0; points != nullptr && i < count; ++i) {
        for (size_t c = 0; c < 4; ++c) {
            const float* row = shapes.rows != nullptr ? shapes.rows[i].centre : nullptr;
            points[4 * i + c] = row != nullptr
                                    ? (c < 3 ? row[c] : shapes.rows[i].size[0])
                                    : shapes.spheres[sphere_word(static_cast<int64_t>(i)) +
                                                     static_cast<int64_t>(c) * sphere_block];
        }
    }
    finish(geometry);
    return geometry;
}

RTCGeometry make_user_triangles(Accel::Impl& impl, int32_t primitive) {
    const Primitive& row = impl.scene->primitives[static_cast<size_t>(primitive)];
    impl.user_triangles.resize(impl.scene->primitives.size());  // once: pointers stay
    UserTriangles& triangles = impl.user_triangles[static_cast<size_t>(primitive)];
    triangles = {impl.scene, row.first_triangle};
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(row.triangle_count));
    rtcSetGeometryUserData(geometry, &triangles);
    rtcSetGeometryBoundsFunction(geometry, triangle_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_triangles);
    rtcSetGeometryOccludedFunction(geometry, occlude_triangles);
    finish(geometry);
    return geometry;
}

}  // namespace obscura
