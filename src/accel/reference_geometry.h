// accel/reference_geometry.h - triangles as user geometry, spheres as Embree's own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

/// True for particles and for primitives whose shape is a sphere.
bool are_spheres(const Accel::Impl& impl, int32_t primitive);

/// The spheres of a primitive as RTC_GEOMETRY_TYPE_SPHERE_POINT, in our order.
RTCGeometry make_sphere_points(Accel::Impl& impl, int32_t primitive);

/// The triangles of a primitive as user geometry that runs intersect_triangle.
RTCGeometry make_checked_triangles(Accel::Impl& impl, int32_t primitive);

}  // namespace obscura
