// gltf/geometry/mesh_plan.h - plans which primitives are read, into which batch, in which order.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_primitive.h"
#include "gltf/geometry/mesh_uses.h"

#include <string>
#include <vector>

namespace obscura::gltf {

/// One primitive to be read.
struct PrimitiveTask {
    PrimitiveName name;
    const MeshUse* use = nullptr;
    int placed = -1;  ///< the node that places it; -1: it stays in its mesh's space
};

/// The space of a batch. dynamic_group: that of the animated node; the geometry is stored once.
/// anchored_group: the world, with the group where it is at shutter open; for points and lines,
/// because no node may scale their radius. mesh: its own, for meshes that have instances.
enum class BatchSpace { world, dynamic_group, anchored_group, mesh };

/// Primitives that share one space.
struct MeshBatch {
    BatchSpace space = BatchSpace::world;
    bool is_static = false;  ///< constant over time
    std::vector<PrimitiveTask> tasks;
    std::vector<int> placed = {};  ///< nodes that place a mesh; one of the dynamic group
};

struct MeshPlan {
    std::vector<MeshBatch> batches;  ///< static ones first; in each half the world's first
    std::vector<std::string> shrunk_nodes =
        {};  ///< nodes that scale their mesh to no area: not drawn
};

/// Says how an asset may change over time.
struct PlanOptions {
    bool posed = false;     ///< animated: dynamic and static geometry are kept apart
    bool anchored = false;  ///< points and lines may move while a shutter is open
};

/// In      uses: outlives the plan; group_from_node: of all nodes, where `posed`
MeshPlan plan_meshes(const Document& document,
                     const std::vector<MeshUse>& uses,
                     const std::vector<PlacedNode>& placed,
                     const std::vector<Affined>& group_from_node,
                     const PlanOptions& options);

}  // namespace obscura::gltf
