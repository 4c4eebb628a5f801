// gltf/geometry/meshes.cpp - the scene's meshes become arrays, baked or instanced.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/meshes.h"

#include "gltf/geometry/batch_reader.h"
#include "gltf/geometry/farthest_position.h"
#include "gltf/geometry/skins.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

class MeshBuilder {
public:
    MeshBuilder(const MeshSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log)
        : sources_(sources),
          problems_(problems),
          scene_(scene),
          log_(log),
          reader_(batch_sources_, materials, problems, scene, log) {}

    Result<void> build();

private:
    const Document& document() const { return sources_.document; }
    const PlacedNode& placed(int index) const {
        return sources_.placed[static_cast<size_t>(index)];
    }

    const std::vector<Affined>& world_from_node() {
        if (world_from_node_.empty()) world_from_node_ = world_transforms(document());
        return world_from_node_;
    }

    void find_uses();
    void drop_uses(int skin, const Error& error);
    size_t take_stored(const std::vector<MeshBatch>& batches);
    Result<void> reserve(const std::vector<MeshBatch>& batches, size_t first);
    Result<std::vector<GeometryBatch>> read(const std::vector<MeshBatch>& batches);
    void add_world(const std::vector<MeshBatch>& batches,
                   const std::vector<GeometryBatch>& geometries);
    void add_mesh(const MeshBatch& batch, const GeometryBatch& geometry);
    void add_instance(const MeshBatch& batch,
                      const GeometryBatch& geometry,
                      const PlacedNode& placed_node);
    bool world_of_batch(const MeshBatch& batch, const PlacedNode& placed_node, Affined& out);
    bool grow_bounds(const MeshBatch& batch, const GeometryBatch& geometry, const Affined& world);
    void store(const std::vector<MeshBatch>& batches, std::vector<GeometryBatch>& geometries);
    void warn();

    const MeshSources& sources_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    std::vector<MeshUse> uses_;                ///< in the order they are met
    std::vector<std::vector<Affined>> skins_;  ///< matrices; empty: no mesh that is drawn has it
    std::vector<Affined> world_from_node_;     ///< of all nodes, where anything asks for it
    std::vector<Affined> no_groups_;
    BatchSources batch_sources_{
        sources_, skins_, sources_.store != nullptr ? sources_.store->group_from_node : no_groups_};
    BatchReader reader_;
    NameList flat_nodes_, shrunk_nodes_;
};

void grow(Bounds& bounds, const Vec3d& p) {
    const Vec3f v{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    bounds.low = {
        std::min(bounds.low.x, v.x), std::min(bounds.low.y, v.y), std::min(bounds.low.z, v.z)};
    bounds.high = max3(bounds.high, v);
}

void MeshBuilder::drop_uses(int skin, const Error& error) {
    size_t lost = 0;
    std::erase_if(uses_, [&](const MeshUse& use) {
        const bool drops = use.skin == skin;
        if (drops) lost += document().meshes[static_cast<size_t>(use.mesh)].primitives.size();
        return drops;
    });
    problems_.add(error, {Loss::primitive, "meshes with the skin are not drawn", lost});
}

void MeshBuilder::find_uses() {
    MeshUses found = find_mesh_uses(document(), sources_.placed);
    uses_ = std::move(found.uses);
    for (const std::string& name : found.flat_nodes)
        flat_nodes_.add(name);
    for (const std::string& name : found.shrunk_nodes)
        shrunk_nodes_.add(name);
    skins_.resize(document().skins.size());
    if (sources_.store != nullptr && sources_.store->group_from_node.empty()) {
        sources_.store->group_from_node = group_transforms(document());
    }
    for (size_t i = 0; i < skins_.size(); ++i) {
        const int skin = static_cast<int>(i);
        const auto has_it = [&](const MeshUse& use) { return use.skin == skin; };
        if (std::none_of(uses_.begin(), uses_.end(), has_it)) continue;
        Result<std::vector<Affined>> matrices =
            skin_matrices(document(), sources_.buffers, world_from_node(), skin);
        if (matrices) skins_[i] = std::move(*matrices);
        if (!matrices) drop_uses(skin, matrices.error());
    }
}

/// Reuses the arrays of an earlier pose up to the first batch that differs; returns how many
/// batches that are.
size_t MeshBuilder::take_stored(const std::vector<MeshBatch>& batches) {
    GeometryStore* store = sources_.store;
    if (store == nullptr) return 0;
    size_t count = 0;
    while (!store->positions.empty() && count < store->batches.size() && count < batches.size() &&
           reader_.is_same(store->batches[count], batches[count])) {
        ++count;
    }
    store->batches.resize(count);
    if (count == 0) return 0;
    const StaticSizes& static_sizes = store->static_sizes();
    scene_.positions = std::move(store->positions);
    scene_.indices = std::move(store->indices);
    scene_.attributes = std::move(store->attributes);
    scene_.positions.resize(static_sizes.positions);
    scene_.indices.resize(static_sizes.indices);
    scene_.attributes.resize(static_sizes.attributes);
    return count;
}

/// Reserves memory for the batches, by the accessors' counts, if they fit.
Result<void> MeshBuilder::reserve(const std::vector<MeshBatch>& batches, size_t first) {
    size_t vertices = 0;
    size_t corners = 0;
    size_t floats = 0;
    for (size_t i = first; i < batches.size(); ++i) {
        for (const PrimitiveTask& task : batches[i].tasks) {
            const GltfMesh& mesh = document().meshes[static_cast<size_t>(task.name.mesh)];
            const GltfPrimitive& primitive =
                mesh.primitives[static_cast<size_t>(task.name.primitive)];
            if (primitive.position < 0) continue;
            const size_t triangles = primitive_triangles(document(), primitive);
            const size_t count = std::min(
                document().accessors[static_cast<size_t>(primitive.position)].count, triangles * 3);
            const MaterialNeeds needs = material_needs(document(), primitive.material);
            const int width = 2 * __builtin_popcount(needs.uv_sets) + (needs.tangents ? 4 : 0) +
                              (primitive.normal >= 0 ? 3 : 0) + (primitive.color >= 0 ? 4 : 0);
            vertices += count;
            corners += triangles * 3;
            floats += count * static_cast<size_t>(width);
        }
    }
    // Asked here, before there are arrays; who keeps the scene charges what it became.
    const auto fits = charge_memory(
        MemoryUse::geometry, document().file, sizeof(float) * (3 * vertices + corners + floats));
    if (!fits) return fail(fits.error());
    constexpr size_t most = 1U << 31;
    scene_.positions.reserve(std::min(most, scene_.positions.size() + vertices * 3 + 4));
    scene_.indices.reserve(std::min(most, scene_.indices.size() + corners + 1));
    scene_.attributes.reserve(std::min(most, scene_.attributes.size() + floats + 4));
    return {};
}

Result<std::vector<GeometryBatch>> MeshBuilder::read(const std::vector<MeshBatch>& batches) {
    std::vector<GeometryBatch> geometries;
    const size_t kept = take_stored(batches);
    if (auto reserved = reserve(batches, kept); !reserved) return fail(reserved.error());
    for (size_t i = 0; i < batches.size(); ++i) {
        if (i < kept) {
            geometries.push_back(std::move(sources_.store->batches[i]));
            reader_.use_again(geometries.back());
            continue;
        }
        Result<GeometryBatch> geometry = reader_.read(batches[i]);
        if (!geometry) return fail(std::move(geometry.error()));
        geometries.push_back(std::move(*geometry));
    }
    return geometries;
}

/// World-space geometry comes first.
void MeshBuilder::add_world(const std::vector<MeshBatch>& batches,
                            const std::vector<GeometryBatch>& geometries) {
    for (size_t i = 0; i < batches.size(); ++i) {
        if (batches[i].space != BatchSpace::world) continue;
        const std::vector<Primitive>& primitives = geometries[i].primitives;
        scene_.primitives.insert(scene_.primitives.end(), primitives.begin(), primitives.end());
        scene_.info.triangles_in_world += geometries[i].triangles;
        scene_.bounds.low = -max3(-scene_.bounds.low, -geometries[i].box.low);
        scene_.bounds.high = max3(scene_.bounds.high, geometries[i].box.high);
        if (!batches[i].is_static) continue;
        scene_.static_primitive_count = static_cast<int32_t>(primitives.size());
        scene_.static_stamp = geometries[i].stamp;
    }
    scene_.world_primitive_count = static_cast<int32_t>(scene_.primitives.size());
}

/// World transform of the batch's space; false: it is not visible now.
bool MeshBuilder::world_of_batch(const MeshBatch& batch,
                                 const PlacedNode& placed_node,
                                 Affined& out) {
    if (!placed_node.visible) return false;
    if (batch.space == BatchSpace::mesh) {
        out = placed_node.world_from_node;
    } else {
        out = world_from_node()[static_cast<size_t>(placed_node.dynamic_group)];
    }
    if (placed_node.dynamic_group >= 0 && is_singular(out)) {
        const int node =
            batch.space == BatchSpace::mesh ? placed_node.node : placed_node.dynamic_group;
        shrunk_nodes_.add(node_label(document(), node));
        return false;
    }
    if (batch.space != BatchSpace::anchored_group) return true;
    const Affined& anchor = (*sources_.anchors)[static_cast<size_t>(placed_node.dynamic_group)];
    if (is_singular(anchor)) return false;
    const bool is_there = std::equal(&anchor.m[0][0], &anchor.m[0][0] + 12, &out.m[0][0]);
    out = is_there ? Affined{} : compose(out, inverse(anchor));
    return true;
}

/// Extends the scene's bounds by an instance; false: it is out of range. What is placed once counts
/// vertex by vertex, as in world space.
bool MeshBuilder::grow_bounds(const MeshBatch& batch,
                              const GeometryBatch& geometry,
                              const Affined& world) {
    Bounds all = scene_.bounds;
    bool in_range = true;
    const auto add = [&](const Vec3d& p) {
        const Vec3d moved = transform_point(world, p);
        in_range = in_range && max_component(abs(moved)) <= farthest_position;
        grow(all, moved);
    };
    if (batch.space == BatchSpace::dynamic_group) {
        const size_t end = geometry.end.indices;
        for (size_t i = end - 3 * geometry.triangles; i < end; ++i) {
            const float* p = &scene_.positions[3 * static_cast<size_t>(scene_.indices[i])];
            add({p[0], p[1], p[2]});
        }
    } else {
        const Bounds& box = geometry.box;
        for (int corner = 0; corner < 8; ++corner) {
            add({(corner & 1) != 0 ? box.high.x : box.low.x,
                 (corner & 2) != 0 ? box.high.y : box.low.y,
                 (corner & 4) != 0 ? box.high.z : box.low.z});
        }
    }
    if (in_range) scene_.bounds = all;
    return in_range;
}

void MeshBuilder::add_instance(const MeshBatch& batch,
                               const GeometryBatch& geometry,
                               const PlacedNode& placed_node) {
    Affined world;
    if (!world_of_batch(batch, placed_node, world)) return;
    const bool own_mesh = batch.space == BatchSpace::mesh;
    Instance instance;
    instance.world_from_object = affine_cast<float>(world);
    instance.object_from_world = affine_cast<float>(inverse(world));
    instance.mesh = static_cast<int32_t>(scene_.meshes.size()) - 1;
    instance.node = own_mesh ? placed_node.node : -1;
    instance.mirrored = determinant(world) < 0 ? 1 : 0;
    bool in_range = true;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            in_range = in_range && std::isfinite(instance.world_from_object.m[r][c]) &&
                       std::isfinite(instance.object_from_world.m[r][c]);
        }
    }
    if (!in_range || !grow_bounds(batch, geometry, world)) {
        const int node = own_mesh ? placed_node.node : placed_node.dynamic_group;
        problems_.add({ExitCode::bad_data,
                       "E-NODE-RANGE",
                       document().at("nodes", static_cast<size_t>(node)),
                       "the node moves vertices of its mesh beyond 1e18, or its scale is beyond "
                       "what single precision can invert"},
                      {Loss::primitive, "the mesh is not drawn there", geometry.primitives.size()});
        return;
    }
    scene_.instances.push_back(instance);
    scene_.info.triangles_in_world += geometry.triangles;
}

void MeshBuilder::add_mesh(const MeshBatch& batch, const GeometryBatch& geometry) {
    if (geometry.primitives.empty()) return;
    scene_.meshes.push_back({static_cast<int32_t>(scene_.primitives.size()),
                             static_cast<int32_t>(geometry.primitives.size()),
                             geometry.stamp});
    scene_.primitives.insert(
        scene_.primitives.end(), geometry.primitives.begin(), geometry.primitives.end());
    for (const int index : batch.placed)
        add_instance(batch, geometry, placed(index));
}

void MeshBuilder::store(const std::vector<MeshBatch>& batches,
                        std::vector<GeometryBatch>& geometries) {
    if (sources_.store == nullptr) return;
    size_t kept = 0;
    while (kept < batches.size() && batches[kept].is_static)
        ++kept;
    geometries.resize(kept);
    sources_.store->batches = std::move(geometries);
}

void MeshBuilder::warn() {
    for (const auto& [issue, list] : reader_.issues()) {
        log_.warn(document().file,
                  std::string(mesh_issue_text(issue)) + "; meshes: " + list.text());
    }
    if (!flat_nodes_.empty()) {
        log_.warn(
            document().file,
            "nodes whose scale is zero along one axis, or whose matrix is singular, are drawn "
            "flat: " +
                flat_nodes_.text());
    }
    if (!shrunk_nodes_.empty()) {
        log_.warn(document().file,
                  "nodes whose scale is zero, or leaves no more than a line, are not drawn: " +
                      shrunk_nodes_.text());
    }
}

Result<void> MeshBuilder::build() {
    if (sources_.store != nullptr) sources_.store->sphere_orders.begin_pose();
    find_uses();
    const MeshPlan plan = plan_meshes(document(),
                                      uses_,
                                      sources_.placed,
                                      batch_sources_.group_from_node,
                                      {sources_.store != nullptr, sources_.anchors != nullptr});
    for (const std::string& name : plan.shrunk_nodes)
        shrunk_nodes_.add(name);
    Result<std::vector<GeometryBatch>> geometries = read(plan.batches);
    if (!geometries) return fail(std::move(geometries.error()));
    add_world(plan.batches, *geometries);
    for (size_t i = 0; i < plan.batches.size(); ++i) {
        if (plan.batches[i].space != BatchSpace::world) add_mesh(plan.batches[i], (*geometries)[i]);
    }
    store(plan.batches, *geometries);
    pad_tables(scene_);
    warn();
    return {};
}

}  // namespace

Result<void> add_meshes(const MeshSources& sources,
                        MaterialTable& materials,
                        Problems& problems,
                        Scene& scene,
                        Log& log) {
    return MeshBuilder(sources, materials, problems, scene, log).build();
}

}  // namespace obscura::gltf
