// accel/user_elements.h - triangles and lines as Embree user geometry with our own callbacks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"
#include "shape/triangle.h"

namespace obscura {

/// Callbacks for the elements of one primitive; `occluded` may be null if it is never called.
struct UserCallbacks {
    RTCBoundsFunction bounds = nullptr;
    RTCIntersectFunctionN intersect = nullptr;
    RTCOccludedFunctionN occluded = nullptr;
};

/// User geometry whose user pointer is impl.user_elements[primitive].
RTCGeometry make_user_elements(Accel::Impl& impl,
                               int32_t primitive,
                               const UserCallbacks& callbacks);

/// Embree's callback: the box of one triangle.
void triangle_bounds(const RTCBoundsFunctionArguments* args);

/// Corners in the primitive's own space.
Triangle<float> read_corners(const UserElements& triangles, unsigned number);

/// Intersects ray i of a packet with a triangle, within the ray's limits. In double precision, so
/// that errors come from Embree's traversal, not from the formula.
TriangleHit<float> meet(const Triangle<float>& triangle, RTCRayN* rays, unsigned n, unsigned i);

/// A callback's hit.
struct UserHit {
    float t;
    Vec3f ng;
    Vec2f uv;
};

UserHit user_hit(const Triangle<float>& triangle, const TriangleHit<float>& hit);

/// Writes a hit into ray i of the packet that a callback was given.
void write_hit(const RTCIntersectFunctionNArguments* args, const UserHit& hit, unsigned i);

}  // namespace obscura
