// dataset/rigid_pose.cpp - a node's matrix as a rigid motion of a stretched model.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/rigid_pose.h"

#include <cmath>

namespace obscura::dataset {

namespace {

/// Squared size of the linear part.
double size_squared(const Affined& a) {
    double sum = 0;
    for (const auto& row : a.m)
        sum += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
    return sum;
}

/// The mean of a linear map and its inverse transpose, both brought to one size first, which makes
/// the steps few. Returns how much it changed.
double step_to_rotation(Affined& a) {
    const Affined inverse_of_a = inverse(a);
    const double balance = std::pow(size_squared(inverse_of_a) / size_squared(a), 0.25);
    double change = 0;
    Affined next;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            next.m[r][c] = 0.5 * (balance * a.m[r][c] + inverse_of_a.m[c][r] / balance);
            change += std::abs(next.m[r][c] - a.m[r][c]);
        }
    }
    a = next;
    return change;
}

}  // namespace

RigidPose rigid_pose(const Affined& world_from_mesh) {
    RigidPose out;
    Affined linear = world_from_mesh;
    for (auto& row : linear.m)
        row[3] = 0;
    // The rotation of a mirroring matrix is that of its negative.
    const double determinant_of_all = determinant(linear);
    if (!(std::abs(determinant_of_all) > 0) || !std::isfinite(determinant_of_all)) {
        out.stretch = linear;
    } else {
        Affined rotation = linear;
        if (determinant_of_all < 0) {
            for (auto& row : rotation.m) {
                for (double& number : row)
                    number = -number;
            }
        }
        constexpr int max_steps = 100;
        constexpr double is_small = 1e-14;
        for (int i = 0; i < max_steps && step_to_rotation(rotation) > is_small; ++i) {
        }
        out.world_from_model = rotation;
        out.stretch = compose(inverse(rotation), linear);
    }
    for (int r = 0; r < 3; ++r)
        out.world_from_model.m[r][3] = world_from_mesh.m[r][3];
    return out;
}

}  // namespace obscura::dataset
