// crosscheck/side_test.cpp - the sides on which a ray passes edges, with rounding bounds.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/side_test.h"

namespace obscura::crosscheck {

namespace {

/// The scalar triple product without its signs: the sum of the sizes of its six products.
double sum_of_products(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d x = abs(a);
    const Vec3d y = abs(b);
    const Vec3d z = abs(c);
    return x.x * (y.y * z.z + y.z * z.y) + x.y * (y.z * z.x + y.x * z.z) +
           x.z * (y.x * z.y + y.y * z.x);
}

}  // namespace

double SideTest::rounding(size_t k) const {
    constexpr double roundings = 7 * 0.5 * ulp_of_one;
    const Vec3d moved = abs(cross(direction, from(k))) + abs(cross(direction, to(k)));
    const double products = sum_of_products(direction, to(k) - from(k), to(k) + from(k));
    return dot(moved, room) + 0.5 * roundings * products + ulp_of_one * abs(facing());
}

SideTest side_test(const TrueScene& scene, const TrueRay& ray, const Item& item, double room_m) {
    const Affined object = scene.object_from_world(item);
    const Triangle<double> world = scene.triangle(item);
    const Vec3d origin = transform_point(object, ray.origin);
    return {{transform_point(object, world.a) - origin,
             transform_point(object, world.b) - origin,
             transform_point(object, world.c) - origin},
            transform_vector(object, ray.direction),
            transform_vector(absolute(object), splat3(room_m))};
}

}  // namespace obscura::crosscheck
