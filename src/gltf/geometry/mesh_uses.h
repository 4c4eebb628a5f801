// gltf/geometry/mesh_uses.h - groups the nodes that show a mesh by its deformed shape.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/node_graph.h"

#include <string>
#include <vector>

namespace obscura::gltf {

/// Placed nodes that show a mesh in the same shape.
struct MeshUse {
    int mesh = 0;
    int skin = -1;                ///< one node only then, whose own transform does not count
    std::vector<double> weights;  ///< of the morph targets; empty: all are 0
    bool bends = false;           ///< time changes weights or joints
    std::vector<int> placed;      ///< in the list of placed nodes; hidden ones too, unless it bends
};

struct MeshUses {
    std::vector<MeshUse> uses;              ///< in the order they are met
    std::vector<std::string> flat_nodes;    ///< nodes that flatten their mesh into a plane
    std::vector<std::string> shrunk_nodes;  ///< nodes that scale their mesh to no area: not drawn
};

/// Leaves out nodes that are never visible.
MeshUses find_mesh_uses(const Document& document, const std::vector<PlacedNode>& placed);

}  // namespace obscura::gltf
