// gltf/geometry/mesh_plan.h - which primitives are read, where to, in which order.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_part.h"
#include "gltf/geometry/mesh_uses.h"

#include <string>
#include <vector>

namespace obscura {

/// One primitive to be read.
struct PartJob {
    PartName name;
    const MeshUse* use = nullptr;
    int placed = -1;  ///< the node that places it; -1: it stays in its mesh's space
};

/// The space of a block of primitives. What an animated node moves is stored once, in that node's
/// own space; points and lines, whose radius no node may stretch, where a shutter finds them when
/// it opens (anchored).
enum class BlockSpace { world, mover, anchored_mover, mesh };

/// Primitives that share one space.
struct MeshBlock {
    BlockSpace space = BlockSpace::world;
    bool keeps = false;  ///< no time changes them
    std::vector<PartJob> jobs;
    std::vector<int> placed = {};  ///< nodes that place a mesh; one that hangs on the mover
};

struct MeshPlan {
    std::vector<MeshBlock> blocks;  ///< those that keep come first, the world's before others
    std::vector<std::string> shrunk_nodes =
        {};  ///< nodes that leave no area of their mesh: not drawn
};

/// What tells how an asset may change.
struct PlanOptions {
    bool posed = false;     ///< it is animated: what moves is kept apart from what stands still
    bool anchored = false;  ///< points and lines may move while a shutter is open
};

/// In      uses: outlives the plan; mover_from_node: of all nodes, where `posed`
MeshPlan plan_meshes(const Document& document,
                     const std::vector<MeshUse>& uses,
                     const std::vector<PlacedNode>& placed,
                     const std::vector<Affined>& mover_from_node,
                     const PlanOptions& options);

}  // namespace obscura
