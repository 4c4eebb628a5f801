// crosscheck/place_check.cpp - checks u, v and Ng against the triangle.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/place_check.h"

#include "crosscheck/side_test.h"

#include <array>
#include <cmath>

namespace obscura::crosscheck {

namespace {

/// Rounding of the sum of weights, besides the error of the sides.
constexpr double share_ulps = 4;

bool is_right_weight(const SideTest& test,
                     const std::array<double, 3>& rounding,
                     size_t k,
                     double said) {
    const double sum = rounding[0] + rounding[1] + rounding[2];
    const double room =
        rounding[k] + std::abs(said) * sum + share_ulps * ulp_of_one * std::abs(test.facing());
    return std::abs(said * test.facing() - test.side(k)) <= room;
}

bool is_right_normal(const SideTest& test, const Vec3d& said) {
    const Vec3d first = test.to(0) - test.from(0);
    const Vec3d second = test.from(2) - test.from(0);
    const double edges = length(first) + length(second);
    // Each edge is between two corners; a product of two of them has been rounded as often as Ng.
    const double room = 2 * length(test.room) * edges + share_ulps * ulp_of_one * edges * edges;
    return length(said - cross(first, second)) <= room;
}

}  // namespace

bool is_right_place(const TrueScene& scene, const TrueRay& ray, const Answer& answer) {
    if (!answer.place.has_uv || answer.item.primitive < 0) return true;
    if (!scene.has(answer.item) || !scene.is_triangle(answer.item)) return true;
    const double unit = scene.rounding_m(ray, answer.item, answer.t);
    const SideTest test = side_test(scene, ray, answer.item, edge_ulps * unit);
    const std::array<double, 3> rounding{test.rounding(0), test.rounding(1), test.rounding(2)};
    // The weight of a corner belongs to the opposite edge.
    return is_right_weight(test, rounding, 2, answer.place.u) &&
           is_right_weight(test, rounding, 0, answer.place.v) &&
           (!answer.place.has_ng || is_right_normal(test, answer.place.ng));
}

}  // namespace obscura::crosscheck
