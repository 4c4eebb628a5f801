// gltf/geometry/mesh_plan.cpp - which primitives are read, where to, in which order.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_plan.h"

#include "gltf/geometry/instancing.h"
#include "gltf/geometry/primitive_modes.h"

#include <algorithm>
#include <map>

namespace obscura {

namespace {

enum class JobKind { triangles, strokes };

class Planner {
public:
    Planner(const Document& document,
            const std::vector<PlacedNode>& placed,
            const std::vector<Affined>& mover_from_node,
            const PlanOptions& options)
        : document_(document),
          placed_(placed),
          mover_from_node_(mover_from_node),
          options_(options) {}

    MeshPlan plan(const std::vector<MeshUse>& uses);

private:
    const GltfNode& node(int placed) const {
        return document_.nodes[static_cast<size_t>(placed_[static_cast<size_t>(placed)].node)];
    }
    const PlacedNode& place(int placed) const { return placed_[static_cast<size_t>(placed)]; }
    int mover(int placed) const {
        return options_.posed ? placed_[static_cast<size_t>(placed)].mover : -1;
    }
    bool is_alone(const MeshUse& use) const {
        return use.placed.size() == 1 && (mover(use.placed[0]) < 0 || use.bends ||
                                          !is_instanced(node(use.placed[0]).instancing));
    }
    void add_jobs(const MeshUse& use, int placed, JobKind kind, MeshBlock& block) const;
    bool has_strokes(const MeshUse& use) const {
        const std::vector<GltfPrimitive>& primitives =
            document_.meshes[static_cast<size_t>(use.mesh)].primitives;
        return std::any_of(primitives.begin(), primitives.end(), [](const GltfPrimitive& p) {
            return is_point_or_line_mode(p.mode) && !p.is_splats;
        });
    }
    void add_single(const MeshUse& use);
    void add_strokes(const MeshUse& use, int placed);
    void add_shared(const MeshUse& use);
    bool is_shrunk(int placed, const Affined& transform);
    MeshBlock& of_mover(std::vector<MeshBlock>& blocks, BlockSpace space, int placed);

    const Document& document_;
    const std::vector<PlacedNode>& placed_;
    const std::vector<Affined>& mover_from_node_;
    const PlanOptions& options_;
    MeshBlock still_, loose_;
    std::vector<MeshBlock> movers_, shared_, bent_, anchored_;
    std::map<std::pair<BlockSpace, int>, size_t> of_mover_;
    std::vector<std::string> shrunk_nodes_;
};

void Planner::add_jobs(const MeshUse& use, int placed, JobKind kind, MeshBlock& block) const {
    const std::vector<GltfPrimitive>& primitives =
        document_.meshes[static_cast<size_t>(use.mesh)].primitives;
    for (size_t i = 0; i < primitives.size(); ++i) {
        const bool strokes = is_point_or_line_mode(primitives[i].mode);
        if (strokes != (kind == JobKind::strokes) || primitives[i].is_splats) continue;
        block.jobs.push_back({{use.mesh, static_cast<int>(i)}, &use, placed});
    }
}

bool Planner::is_shrunk(int placed, const Affined& transform) {
    if (!is_singular(transform) || is_flattening(transform)) return false;
    shrunk_nodes_.push_back(node_label(document_, place(placed).node));
    return true;
}

MeshBlock& Planner::of_mover(std::vector<MeshBlock>& blocks, BlockSpace space, int placed) {
    const auto [entry, is_new] = of_mover_.try_emplace({space, mover(placed)}, blocks.size());
    if (is_new) blocks.push_back({space, space == BlockSpace::mover, {}, {placed}});
    return blocks[entry->second];
}

/// Triangles that one node shows.
void Planner::add_single(const MeshUse& use) {
    const int placed = use.placed[0];
    const PlacedNode& from = place(placed);
    if (use.bends) {
        if (use.skin >= 0 || mover(placed) < 0 || !is_shrunk(placed, from.world_from_node)) {
            add_jobs(use, placed, JobKind::triangles, loose_);
        }
    } else if (mover(placed) < 0) {
        add_jobs(use, placed, JobKind::triangles, still_);
    } else if (!is_shrunk(placed, mover_from_node_[static_cast<size_t>(from.node)])) {
        add_jobs(use, placed, JobKind::triangles, of_mover(movers_, BlockSpace::mover, placed));
    }
}

/// Points and lines: in the world wherever they are, for their radius no node may stretch.
void Planner::add_strokes(const MeshUse& use, int placed) {
    MeshBlock strokes;
    add_jobs(use, placed, JobKind::strokes, strokes);
    const bool moves = mover(placed) >= 0;
    const bool follows = options_.anchored && moves && !use.bends;
    if (follows) {
        const PlacedNode& from = place(placed);
        const Affined& within = mover_from_node_[static_cast<size_t>(from.node)];
        if (is_shrunk(placed, compose(within, from.node_from_mesh))) return;
    } else if (moves) {
        if (!place(placed).visible || is_shrunk(placed, place(placed).world_from_node)) return;
    }
    MeshBlock& to = follows ? of_mover(anchored_, BlockSpace::anchored_mover, placed)
                            : (options_.posed ? loose_ : still_);
    to.jobs.insert(to.jobs.end(), strokes.jobs.begin(), strokes.jobs.end());
}

void Planner::add_shared(const MeshUse& use) {
    MeshBlock block{BlockSpace::mesh, options_.posed && !use.bends, {}, use.placed};
    add_jobs(use, -1, JobKind::triangles, block);
    (use.bends ? bent_ : shared_).push_back(std::move(block));
}

MeshPlan Planner::plan(const std::vector<MeshUse>& uses) {
    still_.keeps = options_.posed;
    for (const MeshUse& use : uses) {
        if (is_alone(use)) add_single(use);
        if (!has_strokes(use)) continue;
        for (const int placed : use.placed)
            add_strokes(use, placed);
    }
    for (const MeshUse& use : uses) {
        if (!is_alone(use)) add_shared(use);
    }
    MeshPlan out;
    out.shrunk_nodes = std::move(shrunk_nodes_);
    const auto take = [&](std::vector<MeshBlock>& blocks) {
        for (MeshBlock& block : blocks)
            out.blocks.push_back(std::move(block));
    };
    out.blocks.push_back(std::move(still_));
    take(movers_);
    take(shared_);
    out.blocks.push_back(std::move(loose_));
    take(bent_);
    take(anchored_);
    return out;
}

}  // namespace

MeshPlan plan_meshes(const Document& document,
                     const std::vector<MeshUse>& uses,
                     const std::vector<PlacedNode>& placed,
                     const std::vector<Affined>& mover_from_node,
                     const PlanOptions& options) {
    return Planner(document, placed, mover_from_node, options).plan(uses);
}

}  // namespace obscura
