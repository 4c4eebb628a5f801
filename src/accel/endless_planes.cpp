// accel/endless_planes.cpp - planes without end, beside what the BVH found.
// SPDX-License-Identifier: Apache-2.0
#include "accel/endless_planes.h"

#include "accel/safe_ray.h"

#include <algorithm>

namespace obscura {

namespace {

/// The row's ray, as planes without end take it.
ShapeRay<float> shape_ray(const RayColumns& rays, int row) {
    return {{rays.ox[row], rays.oy[row], rays.oz[row]}, {rays.dx[row], rays.dy[row], rays.dz[row]}};
}

float longest(const RayColumns& rays, int row) {
    return rays.tfar != nullptr ? rays.tfar[row] : unlimited;
}

}  // namespace

void meet_endless_planes(const Accel::Impl& impl,
                         const QueryContext& context,
                         const RayColumns& rays,
                         const HitColumns& hits,
                         int row) {
    for (const EndlessPlane& plane : impl.endless_planes) {
        const float tfar = hits.primitive[row] >= 0 ? hits.t[row] : longest(rays, row);
        const auto hit = intersect_endless(
            plane, context, shape_ray(rays, row), static_cast<unsigned>(row), tfar);
        if (!hit.found) continue;
        hits.t[row] = hit.t;
        hits.u[row] = 0.0f;
        hits.v[row] = 0.0f;
        hits.instance[row] = plane.instance;
        hits.primitive[row] = plane.primitive;
        hits.triangle[row] = 0;
    }
}

bool endless_plane_hides(const Accel::Impl& impl,
                         const QueryContext& context,
                         const RayColumns& rays,
                         int row) {
    const ShapeRay<float> ray = shape_ray(rays, row);
    const float tfar = longest(rays, row);
    return std::any_of(
        impl.endless_planes.begin(), impl.endless_planes.end(), [&](const EndlessPlane& plane) {
            return intersect_endless(plane, context, ray, static_cast<unsigned>(row), tfar).found;
        });
}

}  // namespace obscura
