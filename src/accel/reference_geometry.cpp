// accel/reference_geometry.cpp - triangles as user geometry, spheres as Embree's own.
// SPDX-License-Identifier: Apache-2.0
#include "accel/reference_geometry.h"

#include "accel/user_elements.h"

namespace obscura {

namespace {

void intersect_triangles(const RTCIntersectFunctionNArguments* args) {
    const auto& triangles = *static_cast<const UserElements*>(args->geometryUserPtr);
    const Triangle<float> triangle = read_corners(triangles, args->primID);
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const TriangleHit<float> hit = meet(triangle, rays, args->N, i);
        if (hit.hit) write_hit(args, user_hit(triangle, hit), i);
    }
}

void occlude_triangles(const RTCOccludedFunctionNArguments* args) {
    const auto& triangles = *static_cast<const UserElements*>(args->geometryUserPtr);
    const Triangle<float> triangle = read_corners(triangles, args->primID);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0 || !meet(triangle, args->ray, args->N, i).hit) continue;
        RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
    }
}

}  // namespace

bool are_spheres(const Accel::Impl& impl, int32_t primitive) {
    const ShapeGeometry& shapes = impl.shapes[static_cast<size_t>(primitive)];
    return shapes.records == nullptr ||
           shapes.records->kind == static_cast<int32_t>(ShapeKind::sphere);
}

RTCGeometry make_sphere_points(Accel::Impl& impl, int32_t primitive) {
    const ShapeGeometry& shapes = impl.shapes[static_cast<size_t>(primitive)];
    const auto count = static_cast<size_t>(shapes.count);
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
    for (size_t i = 0; points != nullptr && i < count; ++i) {
        for (size_t c = 0; c < 4; ++c) {
            const float* centre = shapes.records != nullptr ? shapes.records[i].centre : nullptr;
            points[4 * i + c] = centre != nullptr
                                    ? (c < 3 ? centre[c] : shapes.records[i].size[0])
                                    : shapes.spheres[sphere_word(static_cast<int64_t>(i)) +
                                                     static_cast<int64_t>(c) * sphere_block];
        }
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    return geometry;
}

RTCGeometry make_checked_triangles(Accel::Impl& impl, int32_t primitive) {
    return make_user_elements(
        impl, primitive, {triangle_bounds, intersect_triangles, occlude_triangles});
}

}  // namespace obscura
