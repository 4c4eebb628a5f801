// scene/stretch.cpp - whether instances have scales that differ by direction.
// SPDX-License-Identifier: Apache-2.0
#include "scene/stretch.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace obscura {
namespace {

Vec3d column(const Affinef& a, int c) {
    return {a.m[0][c], a.m[1][c], a.m[2][c]};
}

/// Columns of different lengths, or not at right angles.
bool is_stretched(const Affinef& a) {
    constexpr double rounding = 1e-5;  // of single precision, after some nodes in a row
    const Vec3d x = column(a, 0), y = column(a, 1), z = column(a, 2);
    const double squares[] = {dot(x, x), dot(y, y), dot(z, z)};
    const auto [smallest, largest] = std::minmax_element(std::begin(squares), std::end(squares));
    const double allowed = rounding * *largest;
    return *largest - *smallest > allowed || std::abs(dot(x, y)) > allowed ||
           std::abs(dot(y, z)) > allowed || std::abs(dot(z, x)) > allowed;
}

}  // namespace

bool has_stretched_instances(const Scene& scene) {
    return std::any_of(
               scene.instances.begin(),
               scene.instances.end(),
               [](const Instance& instance) { return is_stretched(instance.world_from_object); }) ||
           std::any_of(scene.motion.instances.begin(), scene.motion.instances.end(), is_stretched);
}

}  // namespace obscura
