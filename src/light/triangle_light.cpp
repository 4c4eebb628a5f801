// light/triangle_light.cpp - computes the geometric part of a light triangle's record.
// SPDX-License-Identifier: Apache-2.0
#include "light/triangle_light.h"

#include <cmath>

namespace obscura {
namespace {

void store(const Vec3d& v, float* out) {
    out[0] = static_cast<float>(v.x);
    out[1] = static_cast<float>(v.y);
    out[2] = static_cast<float>(v.z);
}

Vec3d widen(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

TriangleLight make_triangle_light(const Vec3f& p0, const Vec3f& p1, const Vec3f& p2) {
    const Vec3d origin = widen(p0);
    const Vec3d e1 = widen(p1) - origin;
    const Vec3d e2 = widen(p2) - origin;
    TriangleLight light;
    const auto area = static_cast<float>(0.5 * length(cross(e1, e2)));
    if (!std::isfinite(area)) return light;
    store(origin, light.p0);
    store(e1, light.e1);
    store(e2, light.e2);
    light.area = area;
    return light;
}

}  // namespace obscura
