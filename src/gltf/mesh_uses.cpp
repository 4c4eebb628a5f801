// gltf/mesh_uses.cpp - which nodes show a mesh, and in which shape.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/mesh_uses.h"

#include <map>
#include <tuple>

namespace obscura {

namespace {

/// What tells two shapes of a mesh apart: mesh, skinned node (-1: none), weights.
using ShapeKey = std::tuple<int, int, std::vector<double>>;

/// The weights that a node gives its mesh.
std::vector<double> weights_of(const Document& document, const GltfNode& node) {
    const GltfMesh& mesh = document.meshes[static_cast<size_t>(node.mesh)];
    if (mesh.target_count == 0) return {};
    return node.weights.empty() ? mesh.weights : node.weights;
}

}  // namespace

MeshUses find_mesh_uses(const Document& document, const std::vector<PlacedNode>& placed) {
    MeshUses out;
    std::map<ShapeKey, size_t> known;
    for (size_t i = 0; i < placed.size(); ++i) {
        const PlacedNode& place = placed[i];
        const GltfNode& node = document.nodes[static_cast<size_t>(place.node)];
        if (node.mesh < 0 || !place.visible) continue;
        if (node.skin < 0 && is_singular(place.world_from_node)) {
            out.flat_nodes.push_back(node.name.empty() ? "node " + std::to_string(place.node)
                                                       : node.name);
            continue;
        }
        std::vector<double> weights = weights_of(document, node);
        const int skinned = node.skin < 0 ? -1 : place.node;
        const auto [entry, is_new] =
            known.try_emplace({node.mesh, skinned, weights}, out.uses.size());
        if (is_new) out.uses.push_back({node.mesh, node.skin, std::move(weights), {}});
        MeshUse& use = out.uses[entry->second];
        // Instances of a skinned node would all lie in the same place.
        if (node.skin < 0 || use.placed.empty()) use.placed.push_back(static_cast<int>(i));
    }
    return out;
}

}  // namespace obscura
