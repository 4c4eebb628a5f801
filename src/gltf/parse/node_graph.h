// gltf/parse/node_graph.h - the tree of nodes: checked, and flattened to world transforms.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <string>
#include <vector>

namespace obscura::gltf {

/// A node of the chosen scene, in depth-first order.
struct PlacedNode {
    int node = 0;
    Affined world_from_node;  ///< of an instance (gltf/geometry/instancing.h): where its mesh is
    Affined node_from_mesh = {};  ///< of an instance; no time changes it
    bool visible = true;          ///< false: only its camera counts (KHR_node_visibility)
    bool may_show = true;         ///< at some time it is visible, as far as animations tell
    int dynamic_group = -1;  ///< the nearest animated node, itself or above it; -1: it is static
};

/// Every node has at most one parent and none is its own ancestor. Linear in the file's size.
///
/// Errors  65 E-NODE-PARENTS, E-NODE-CYCLE, both naming the nodes
Result<void> check_node_graph(const Document& document);

/// The nodes that a scene reaches, without those that stand for others far away (MSFT_lod) and
/// what hangs on them. scene -1: the file has no scenes, all root nodes are taken.
std::vector<PlacedNode> place_nodes(const Document& document, int scene, Log& log);

/// Where all nodes are in the world, whatever scene they are in.
std::vector<Affined> world_transforms(const Document& document);

/// Where all nodes are in the space of their PlacedNode::dynamic_group, which no time changes; in
/// the world where they have none.
std::vector<Affined> group_transforms(const Document& document);

/// By node: 1 where it belongs to a dynamic group.
std::vector<char> moving_nodes(const Document& document);

/// A node's name, else its number, for messages.
std::string node_label(const Document& document, int node);

/// True when a transform squashes space to a plane, a line or a point, or is not finite.
bool is_singular(const Affined& transform);

/// True when it flattens space to a plane, in which geometry is still visible.
bool is_flattening(const Affined& transform);

/// True when one axis is scaled to almost nothing beside another: single precision holds the
/// vertices, but not the rays that the inverse would move.
bool is_nearly_flat(const Affined& transform);

}  // namespace obscura::gltf
