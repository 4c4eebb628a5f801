// gltf/geometry/mesh_uses.cpp - groups the nodes that show a mesh by its deformed shape.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_uses.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace obscura::gltf {

namespace {

/// Identifies a shape of a mesh: mesh, the node that alone deforms it (-1: none), weights.
using ShapeKey = std::tuple<int, int, std::vector<double>>;

/// The weights that a node gives its mesh.
std::vector<double> weights_of(const Document& document, const GltfNode& node) {
    const GltfMesh& mesh = document.meshes[static_cast<size_t>(node.mesh)];
    if (mesh.target_count == 0) return {};
    return node.weights.empty() ? mesh.weights : node.weights;
}

/// Whether the shape of a placed mesh changes over time. A moving skin counts, and so does a
/// skinned mesh that appears or vanishes: it never lies in a dynamic group's space.
bool bends(const Document& document,
           const PlacedNode& placed_node,
           const std::vector<char>& moving) {
    const GltfNode& node = document.nodes[static_cast<size_t>(placed_node.node)];
    const bool own_weights = !node.weights.empty();
    if (node.bends || (!own_weights && document.meshes[static_cast<size_t>(node.mesh)].bends)) {
        return true;
    }
    if (node.skin < 0) return false;
    const std::vector<int>& joints = document.skins[static_cast<size_t>(node.skin)].joints;
    const auto moves = [&](int joint) { return moving[static_cast<size_t>(joint)] != 0; };
    return placed_node.dynamic_group >= 0 || std::any_of(joints.begin(), joints.end(), moves);
}

}  // namespace

MeshUses find_mesh_uses(const Document& document, const std::vector<PlacedNode>& placed) {
    MeshUses out;
    std::map<ShapeKey, size_t> known;
    std::vector<char> moving;  // asked for joints only
    if (!document.skins.empty()) moving = moving_nodes(document);
    for (size_t i = 0; i < placed.size(); ++i) {
        const PlacedNode& placed_node = placed[i];
        const GltfNode& node = document.nodes[static_cast<size_t>(placed_node.node)];
        if (node.mesh < 0 || !placed_node.may_show) continue;
        const bool flat = node.skin < 0 && is_flattening(placed_node.world_from_node);
        if (node.skin < 0 && placed_node.dynamic_group < 0 && !flat &&
            is_singular(placed_node.world_from_node)) {
            out.shrunk_nodes.push_back(node_label(document, placed_node.node));
            continue;
        }
        const bool thin = node.skin < 0 && !flat && is_nearly_flat(placed_node.world_from_node);
        // Instances cannot be flat: a mesh is read again for a node that flattens it.
        const bool is_bent = bends(document, placed_node, moving) ||
                             ((flat || thin) && placed_node.dynamic_group >= 0);
        if (is_bent && !placed_node.visible) continue;
        std::vector<double> weights = weights_of(document, node);
        if (flat) out.flat_nodes.push_back(node_label(document, placed_node.node));
        if (flat || thin) {
            const auto index = static_cast<int>(i);
            out.uses.push_back({node.mesh, -1, std::move(weights), is_bent, {index}});
            continue;
        }
        // Nodes that deform their mesh share no shape, even if shapes agree at some time.
        const int own = node.skin >= 0 || node.bends ? placed_node.node : -1;
        const auto [entry, is_new] = known.try_emplace({node.mesh, own, weights}, out.uses.size());
        if (is_new) out.uses.push_back({node.mesh, node.skin, std::move(weights), is_bent, {}});
        MeshUse& use = out.uses[entry->second];
        // All instances of a skinned node would coincide.
        if (node.skin < 0 || use.placed.empty()) use.placed.push_back(static_cast<int>(i));
    }
    return out;
}

}  // namespace obscura::gltf
