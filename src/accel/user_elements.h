// accel/user_elements.h - triangles or lines as user geometry, for callbacks of our own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"
#include "shape/triangle.h"

namespace obscura {

/// Callbacks for the elements of one primitive; `occluded` may be null where nobody asks.
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

/// Ray i of a packet against a triangle, within the ray's limits. In double precision: what then
/// differs from the truth is Embree's way through its boxes, not the formula.
TriangleHit<float> meet(const Triangle<float>& triangle, RTCRayN* rays, unsigned n, unsigned i);

/// What a callback found.
struct UserHit {
    float t;
    Vec3f ng;
    Vec2f uv;
};

UserHit user_hit(const Triangle<float>& triangle, const TriangleHit<float>& hit);

/// Writes a hit into ray i of the packet that a callback was given.
void write_hit(const RTCIntersectFunctionNArguments* args, const UserHit& hit, unsigned i);

}  // namespace obscura
