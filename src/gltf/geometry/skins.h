// gltf/geometry/skins.h - the joint matrices of a skin: world space from bind pose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/accessors.h"

#include <vector>

namespace obscura::gltf {

/// For each joint of a skin: the transform to the world from the pose in which the mesh was bound.
///
/// In      world_from_node: of all nodes, because joints need not be in the drawn scene
/// Errors  65 E-SKIN-MATRICES an inverse bind matrix is not finite; those of read_floats
Result<std::vector<Affined>> skin_matrices(const Document& document,
                                           const BufferStore& buffers,
                                           const std::vector<Affined>& world_from_node,
                                           int skin);

}  // namespace obscura::gltf
