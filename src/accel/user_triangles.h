// accel/user_triangles.h - a primitive's triangles as user geometry, for callbacks of our own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"
#include "shape/triangle.h"

namespace obscura {

/// Callbacks for the triangles of one primitive; `occluded` may be null where nobody asks.
struct TriangleCallbacks {
    RTCIntersectFunctionN intersect = nullptr;
    RTCOccludedFunctionN occluded = nullptr;
};

/// User geometry whose user pointer is impl.user_triangles[primitive].
RTCGeometry make_user_triangles(Accel::Impl& impl,
                                int32_t primitive,
                                const TriangleCallbacks& callbacks);

/// Corners in the primitive's own space.
Triangle<float> read_corners(const UserTriangles& triangles, unsigned number);

/// Ray i of a packet against a triangle, within the ray's limits. In double precision: what then
/// differs from the truth is Embree's way through its boxes, not the formula.
TriangleHit<float> meet(const Triangle<float>& triangle, RTCRayN* rays, unsigned n, unsigned i);

/// Writes a hit of meet() into ray i of the packet that a callback was given.
void write_hit(const RTCIntersectFunctionNArguments* args,
               const Triangle<float>& triangle,
               const TriangleHit<float>& hit,
               unsigned i);

}  // namespace obscura
