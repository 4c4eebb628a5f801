// gltf/geometry/mesh_uses.h - which nodes show a mesh, and in which shape.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/node_graph.h"

#include <string>
#include <vector>

namespace obscura {

/// Placed nodes that show a mesh in one and the same shape.
struct MeshUse {
    int mesh = 0;
    int skin = -1;                ///< then there is one node, and its own place does not count
    std::vector<double> weights;  ///< of the morph targets; empty: all are 0
    bool bends = false;           ///< time changes weights or joints
    std::vector<int> placed;      ///< in the list of placed nodes; hidden ones too, unless it bends
};

struct MeshUses {
    std::vector<MeshUse> uses;              ///< in the order they are met
    std::vector<std::string> flat_nodes;    ///< nodes that press their mesh into a plane
    std::vector<std::string> shrunk_nodes;  ///< nodes that leave no area of their mesh: not drawn
};

/// Nodes that are never seen are left out.
MeshUses find_mesh_uses(const Document& document, const std::vector<PlacedNode>& placed);

}  // namespace obscura
