// gltf/geometry/shapes.cpp - the scene's analytic shapes become primitives and instances.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/shapes.h"

#include "gltf/geometry/farthest_position.h"
#include "gltf/geometry/particles.h"
#include "gltf/parse/list_text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace obscura::gltf {

namespace {

/// A uniform scale and a translation; nothing when the map rotates, mirrors or stretches.
std::optional<double> uniform_scale(const Affined& map) {
    const double s = map.m[0][0];
    double off = 0;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            off = std::max(off, std::abs(map.m[r][c] - (r == c ? s : 0)));
    }
    if (!(s > 0) || off > 1e-9 * s) return std::nullopt;
    return s;
}

class ShapeBuilder {
public:
    ShapeBuilder(const MeshSources& sources,
                 MaterialTable& materials,
                 Problems& problems,
                 Scene& scene,
                 Log& log)
        : sources_(sources), materials_(materials), problems_(problems), scene_(scene), log_(log) {}

    void build();

private:
    const Document& document() const { return sources_.document; }
    const GltfShape& shape(int index) const {
        return document().shapes[static_cast<size_t>(index)];
    }
    const GltfNode& node(const PlacedNode& placed_node) const {
        return document().nodes[static_cast<size_t>(placed_node.node)];
    }
    int32_t choose_material(int material, bool double_sided);
    Result<Primitive> make_primitive(const PlacedNode& placed_node, const Affined* baked);
    Result<void> add_particles(const PlacedNode& placed_node, Primitive& primitive);
    Result<Primitive> make_world_primitive(const PlacedNode& placed_node);
    void add_to_world(const std::vector<const PlacedNode*>& placed_nodes);
    Result<int32_t> instanced_mesh(const PlacedNode& placed_node);
    Result<void> add_instance(const PlacedNode& placed_node);
    Result<void> grow_bounds(const PlacedNode& placed_node, const ShapeBox& box);
    void count(const GltfShape& shape, int32_t added);
    void report(const Error& error) {
        problems_.add(error, {Loss::primitive, "the shape is not drawn"});
    }

    const MeshSources& sources_;
    MaterialTable& materials_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    std::map<int32_t, int32_t> double_sided_;           ///< material records made double-sided
    std::map<std::pair<int, int>, int32_t> instanced_;  ///< mesh of (shape, material)
    std::map<int32_t, ShapeBox> mesh_boxes_;            ///< by mesh index
};

int32_t ShapeBuilder::choose_material(int material, bool double_sided) {
    const MaterialChoice choice = material_for_surface(materials_, material, 1U);
    if (choice.is_new) {
        log_.warn(document().at("materials", static_cast<size_t>(material)),
                  lost_slots_text(materials_, choice) + "; on shapes the factors alone count");
    }
    const int32_t chosen = choice.index;
    const auto index = static_cast<size_t>(chosen);
    const uint32_t flags = materials_.records[index].flags;
    if (!double_sided || glows_on_both_sides(flags)) return chosen;
    const auto [entry, is_new] =
        double_sided_.try_emplace(chosen, static_cast<int32_t>(materials_.records.size()));
    if (is_new) {
        Material copy = materials_.records[index];
        copy.flags = (flags | material_double_sided) & ~uint32_t{material_glows_in_front};
        const int added = add_copy(materials_, chosen, copy, materials_.layers[index]);
        materials_.used[static_cast<size_t>(added)] = 1;
    }
    return entry->second;
}

void ShapeBuilder::count(const GltfShape& counted, int32_t added) {
    std::vector<NamedCount>& list = scene_.info.shapes;
    const auto found = std::find_if(
        list.begin(), list.end(), [&](const NamedCount& c) { return c.name == counted.type; });
    if (found == list.end()) {
        list.push_back({counted.type, static_cast<size_t>(added)});
    } else {
        found->count += static_cast<size_t>(added);
    }
}

Result<void> ShapeBuilder::add_particles(const PlacedNode& placed_node, Primitive& primitive) {
    const GltfShape& particles = shape(node(placed_node).shape);
    GeometryStore* store = sources_.store;
    SphereOrders* orders = store != nullptr ? &store->sphere_orders : nullptr;
    const Result<ParticleRange> range = append_particles(
        {document(), sources_.buffers, orders}, particles, node(placed_node).shape, scene_);
    if (!range) return fail(range.error());
    primitive.geometry = static_cast<int32_t>(GeometryKind::spheres);
    primitive.first_triangle = range->first;
    primitive.triangle_count = range->count;
    return {};
}

/// The primitive of a node's shape; moved to the world where `baked`.
Result<Primitive> ShapeBuilder::make_primitive(const PlacedNode& placed_node,
                                               const Affined* baked) {
    const GltfShape& own = shape(node(placed_node).shape);
    Primitive out;
    out.material = choose_material(node(placed_node).shape_material, own.double_sided);
    out.tangent_base = 0;
    out.uv_base[0] = 0;
    out.geometry = static_cast<int32_t>(GeometryKind::shapes);
    if (own.positions >= 0) {
        const Result<void> added = add_particles(placed_node, out);
        if (!added) return fail(added.error());
        return out;
    }
    out.first_triangle = static_cast<int32_t>(scene_.shapes.size());
    out.triangle_count = 1;
    ShapeRecord record = own.record;
    if (baked != nullptr) {
        const auto& m = baked->m;
        record = scaled_and_moved(record, m[0][0], {m[0][3], m[1][3], m[2][3]});
    }
    scene_.shapes.push_back(record);
    return out;
}

Result<void> ShapeBuilder::grow_bounds(const PlacedNode& placed_node, const ShapeBox& box) {
    bool in_range = true;
    Bounds all = scene_.bounds;
    const auto cut = [](float v) { return std::isfinite(v) ? v : std::copysign(0.5f, v); };
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p{cut((corner & 1) != 0 ? box.high.x : box.low.x),
                      cut((corner & 2) != 0 ? box.high.y : box.low.y),
                      cut((corner & 4) != 0 ? box.high.z : box.low.z)};
        const Vec3d moved = transform_point(placed_node.world_from_node, p);
        in_range = in_range && max_component(abs(moved)) <= farthest_position;
        const Vec3f v{
            static_cast<float>(moved.x), static_cast<float>(moved.y), static_cast<float>(moved.z)};
        all.low = {std::min(all.low.x, v.x), std::min(all.low.y, v.y), std::min(all.low.z, v.z)};
        all.high = max3(all.high, v);
    }
    if (in_range) {
        scene_.bounds = all;
        return {};
    }
    return fail(ExitCode::bad_data,
                "E-NODE-RANGE",
                document().at("nodes", static_cast<size_t>(placed_node.node)),
                "the node moves its shape beyond 1e18");
}

Result<Primitive> ShapeBuilder::make_world_primitive(const PlacedNode& placed_node) {
    const GltfShape& own = shape(node(placed_node).shape);
    const Result<void> grown = grow_bounds(placed_node, shape_bounds(own.record));
    if (!grown) return fail(grown.error());
    Result<Primitive> primitive = make_primitive(placed_node, &placed_node.world_from_node);
    if (!primitive) return primitive;
    primitive->node = placed_node.node;
    count(own, 1);
    return primitive;
}

/// Primitives in world space come before those of meshes.
void ShapeBuilder::add_to_world(const std::vector<const PlacedNode*>& placed_nodes) {
    std::vector<Primitive> world;
    for (const PlacedNode* placed_node : placed_nodes) {
        const Result<Primitive> primitive = make_world_primitive(*placed_node);
        if (primitive) world.push_back(*primitive);
        if (!primitive) report(primitive.error());
    }
    const auto added = static_cast<int32_t>(world.size());
    scene_.primitives.insert(
        scene_.primitives.begin() + scene_.world_primitive_count, world.begin(), world.end());
    scene_.world_primitive_count += added;
    for (Mesh& mesh : scene_.meshes)
        mesh.first_primitive += added;
}

/// The mesh of a node's shape, made where it is the first such node.
Result<int32_t> ShapeBuilder::instanced_mesh(const PlacedNode& placed_node) {
    const std::pair<int, int> key{node(placed_node).shape, node(placed_node).shape_material};
    const auto known = instanced_.find(key);
    if (known != instanced_.end()) return known->second;
    const Result<Primitive> primitive = make_primitive(placed_node, nullptr);
    if (!primitive) return fail(primitive.error());
    const auto index = static_cast<int32_t>(scene_.meshes.size());
    scene_.meshes.push_back({static_cast<int32_t>(scene_.primitives.size()), 1});
    scene_.primitives.push_back(*primitive);
    mesh_boxes_[index] = primitive_box(scene_, *primitive);
    instanced_[key] = index;
    return index;
}

Result<void> ShapeBuilder::add_instance(const PlacedNode& placed_node) {
    const Result<int32_t> index = instanced_mesh(placed_node);
    if (!index) return fail(index.error());
    const Result<void> grown = grow_bounds(placed_node, mesh_boxes_[*index]);
    if (!grown) return grown;
    const Mesh& mesh = scene_.meshes[static_cast<size_t>(*index)];
    Instance instance;
    instance.world_from_object = affine_cast<float>(placed_node.world_from_node);
    instance.object_from_world = affine_cast<float>(inverse(placed_node.world_from_node));
    instance.mesh = *index;
    instance.node = placed_node.node;
    instance.mirrored = determinant(placed_node.world_from_node) < 0 ? 1 : 0;
    scene_.instances.push_back(instance);
    count(shape(node(placed_node).shape),
          scene_.primitives[static_cast<size_t>(mesh.first_primitive)].triangle_count);
    return {};
}

void ShapeBuilder::build() {
    std::vector<const PlacedNode*> world;
    std::vector<const PlacedNode*> moved;
    std::vector<std::string> flat;
    for (const PlacedNode& placed_node : sources_.placed) {
        const int index = node(placed_node).shape;
        if (index < 0 || !placed_node.visible) continue;
        if (is_singular(placed_node.world_from_node)) {
            flat.push_back(document().at("nodes", static_cast<size_t>(placed_node.node)));
            continue;
        }
        const bool single = shape(index).positions < 0;
        const bool stays =
            single && placed_node.dynamic_group < 0 && uniform_scale(placed_node.world_from_node);
        (stays ? world : moved).push_back(&placed_node);
    }
    if (!flat.empty()) {
        log_.warn(document().file,
                  "shapes whose node's scale is zero or whose matrix is singular are not drawn: " +
                      list_text(flat));
    }
    add_to_world(world);
    for (const PlacedNode* placed_node : moved) {
        const Result<void> added = add_instance(*placed_node);
        if (!added) report(added.error());
    }
}

}  // namespace

void add_shapes(const MeshSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log) {
    ShapeBuilder(sources, materials, problems, scene, log).build();
}

}  // namespace obscura::gltf
