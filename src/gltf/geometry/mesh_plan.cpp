// gltf/geometry/mesh_plan.cpp - plans which primitives are read, into which batch, in which order.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_plan.h"

#include "gltf/geometry/instancing.h"
#include "gltf/geometry/primitive_modes.h"

#include <algorithm>
#include <map>

namespace obscura::gltf {

namespace {

enum class ElementKind { triangles, points_lines };

class Planner {
public:
    Planner(const Document& document,
            const std::vector<PlacedNode>& placed,
            const std::vector<Affined>& group_from_node,
            const PlanOptions& options)
        : document_(document),
          placed_(placed),
          group_from_node_(group_from_node),
          options_(options) {}

    MeshPlan plan(const std::vector<MeshUse>& uses);

private:
    const GltfNode& node(int placed) const {
        return document_.nodes[static_cast<size_t>(placed_[static_cast<size_t>(placed)].node)];
    }
    const PlacedNode& placed_node(int placed) const { return placed_[static_cast<size_t>(placed)]; }
    int dynamic_group(int placed) const {
        return options_.posed ? placed_[static_cast<size_t>(placed)].dynamic_group : -1;
    }
    bool is_alone(const MeshUse& use) const {
        return use.placed.size() == 1 && (dynamic_group(use.placed[0]) < 0 || use.bends ||
                                          !is_instanced(node(use.placed[0]).instancing));
    }
    void add_tasks(const MeshUse& use, int placed, ElementKind kind, MeshBatch& batch) const;
    bool has_points_lines(const MeshUse& use) const {
        const std::vector<GltfPrimitive>& primitives =
            document_.meshes[static_cast<size_t>(use.mesh)].primitives;
        return std::any_of(primitives.begin(), primitives.end(), [](const GltfPrimitive& p) {
            return is_point_or_line_mode(p.mode) && !p.is_splats;
        });
    }
    void add_single(const MeshUse& use);
    void add_points_lines(const MeshUse& use, int placed);
    void add_shared(const MeshUse& use);
    bool is_shrunk(int placed, const Affined& transform);
    MeshBatch& batch_of_group(std::vector<MeshBatch>& batches, BatchSpace space, int placed);

    const Document& document_;
    const std::vector<PlacedNode>& placed_;
    const std::vector<Affined>& group_from_node_;
    const PlanOptions& options_;
    MeshBatch static_batch_, dynamic_batch_;
    std::vector<MeshBatch> groups_, shared_, deformed_, anchored_;
    std::map<std::pair<BatchSpace, int>, size_t> batch_of_group_;
    std::vector<std::string> shrunk_nodes_;
};

void Planner::add_tasks(const MeshUse& use, int placed, ElementKind kind, MeshBatch& batch) const {
    const std::vector<GltfPrimitive>& primitives =
        document_.meshes[static_cast<size_t>(use.mesh)].primitives;
    for (size_t i = 0; i < primitives.size(); ++i) {
        const bool points_lines = is_point_or_line_mode(primitives[i].mode);
        if (points_lines != (kind == ElementKind::points_lines) || primitives[i].is_splats)
            continue;
        if (primitives[i].mode == hidden_mode) continue;
        batch.tasks.push_back({{use.mesh, static_cast<int>(i)}, &use, placed});
    }
}

bool Planner::is_shrunk(int placed, const Affined& transform) {
    if (!is_singular(transform) || is_flattening(transform)) return false;
    shrunk_nodes_.push_back(node_label(document_, placed_node(placed).node));
    return true;
}

MeshBatch& Planner::batch_of_group(std::vector<MeshBatch>& batches, BatchSpace space, int placed) {
    const auto [entry, is_new] =
        batch_of_group_.try_emplace({space, dynamic_group(placed)}, batches.size());
    if (is_new) batches.push_back({space, space == BatchSpace::dynamic_group, {}, {placed}});
    return batches[entry->second];
}

/// Triangles that one node shows.
void Planner::add_single(const MeshUse& use) {
    const int placed = use.placed[0];
    const PlacedNode& from = placed_node(placed);
    if (use.bends) {
        if (use.skin >= 0 || dynamic_group(placed) < 0 ||
            !is_shrunk(placed, from.world_from_node)) {
            add_tasks(use, placed, ElementKind::triangles, dynamic_batch_);
        }
    } else if (dynamic_group(placed) < 0) {
        add_tasks(use, placed, ElementKind::triangles, static_batch_);
    } else if (!is_shrunk(placed, group_from_node_[static_cast<size_t>(from.node)])) {
        add_tasks(use,
                  placed,
                  ElementKind::triangles,
                  batch_of_group(groups_, BatchSpace::dynamic_group, placed));
    }
}

/// Points and lines go to world space, because no node may scale their radius.
void Planner::add_points_lines(const MeshUse& use, int placed) {
    MeshBatch points_lines;
    add_tasks(use, placed, ElementKind::points_lines, points_lines);
    const bool moves = dynamic_group(placed) >= 0;
    const bool follows = options_.anchored && moves && !use.bends;
    if (follows) {
        const PlacedNode& from = placed_node(placed);
        const Affined& within = group_from_node_[static_cast<size_t>(from.node)];
        if (is_shrunk(placed, compose(within, from.node_from_mesh))) return;
    } else if (moves) {
        if (!placed_node(placed).visible || is_shrunk(placed, placed_node(placed).world_from_node))
            return;
    }
    MeshBatch& to = follows ? batch_of_group(anchored_, BatchSpace::anchored_group, placed)
                            : (options_.posed ? dynamic_batch_ : static_batch_);
    to.tasks.insert(to.tasks.end(), points_lines.tasks.begin(), points_lines.tasks.end());
}

void Planner::add_shared(const MeshUse& use) {
    MeshBatch batch{BatchSpace::mesh, options_.posed && !use.bends, {}, use.placed};
    add_tasks(use, -1, ElementKind::triangles, batch);
    (use.bends ? deformed_ : shared_).push_back(std::move(batch));
}

MeshPlan Planner::plan(const std::vector<MeshUse>& uses) {
    static_batch_.is_static = options_.posed;
    for (const MeshUse& use : uses) {
        if (is_alone(use)) add_single(use);
        if (!has_points_lines(use)) continue;
        for (const int placed : use.placed)
            add_points_lines(use, placed);
    }
    for (const MeshUse& use : uses) {
        if (!is_alone(use)) add_shared(use);
    }
    MeshPlan out;
    out.shrunk_nodes = std::move(shrunk_nodes_);
    const auto take = [&](std::vector<MeshBatch>& batches) {
        for (MeshBatch& batch : batches)
            out.batches.push_back(std::move(batch));
    };
    out.batches.push_back(std::move(static_batch_));
    take(groups_);
    take(shared_);
    out.batches.push_back(std::move(dynamic_batch_));
    take(deformed_);
    take(anchored_);
    return out;
}

}  // namespace

MeshPlan plan_meshes(const Document& document,
                     const std::vector<MeshUse>& uses,
                     const std::vector<PlacedNode>& placed,
                     const std::vector<Affined>& group_from_node,
                     const PlanOptions& options) {
    return Planner(document, placed, group_from_node, options).plan(uses);
}

}  // namespace obscura::gltf
