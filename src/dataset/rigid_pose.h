// dataset/rigid_pose.h - a node's matrix as a rigid motion of a stretched model.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/transform.h"

namespace obscura::dataset {

/// A matrix as a product: world_from_model moves, and `stretch` scales or mirrors the mesh before,
/// so that the model that is moved has its true size. Both are the nearest of their kind.
struct RigidPose {
    Affined world_from_model;  ///< a rotation and a translation
    Affined stretch;           ///< symmetric, without translation
};

/// Source  N. J. Higham, "Computing the polar decomposition - with applications", 1986: the mean of
///         a matrix and its inverse transpose, again and again
RigidPose rigid_pose(const Affined& world_from_mesh);

}  // namespace obscura::dataset
