// gltf/geometry/batch_reader.cpp - appends the primitives of a batch to the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/batch_reader.h"

#include "base/parallel.h"
#include "gltf/geometry/mesh_append.h"
#include "gltf/geometry/points_lines.h"
#include "image/rendering_space.h"

#include <algorithm>
#include <optional>

namespace obscura::gltf {

namespace {

void grow(Bounds& bounds, const Vec3f& p) {
    bounds.low = {
        std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y), std::min(bounds.low.z, p.z)};
    bounds.high = {
        std::max(bounds.high.x, p.x), std::max(bounds.high.y, p.y), std::max(bounds.high.z, p.z)};
}

/// Tangents follow the coordinates of the normal map.
bool have_same_needs(const MaterialNeeds& a, const MaterialNeeds& b) {
    const TextureSlot& p = a.normal_map;
    const TextureSlot& q = b.normal_map;
    return a.uv_sets == b.uv_sets && a.tangents == b.tangents && p.texture == q.texture &&
           p.uv_set == q.uv_set && std::equal(p.uv_from_mesh, p.uv_from_mesh + 6, q.uv_from_mesh);
}

PrimitiveNote note_of(const PrimitiveTask& task, const MeshPrimitive& primitive) {
    PrimitiveNote out;
    out.name = task.name;
    out.corners = primitive.corners;
    out.issues = primitive.issues;
    for (size_t set = 0; set < primitive.uvs.size(); ++set) {
        if (!primitive.uvs[set].empty()) out.uv_sets |= 1U << set;
    }
    out.shading = {!primitive.normals.empty(), out.uv_sets};
    return out;
}

}  // namespace

std::string BatchReader::place(const PrimitiveName& name) const {
    return document().at("meshes", static_cast<size_t>(name.mesh)) + "/primitives/" +
           std::to_string(name.primitive);
}

/// Primitives are read on all cores a chunk at a time, so that not all are in memory twice.
size_t BatchReader::chunk_end(const std::vector<PrimitiveTask>& tasks, size_t begin) const {
    constexpr uint64_t chunk_corners = 3U << 20;
    uint64_t corners = 0;
    size_t end = begin;
    while (end < tasks.size() && (end == begin || corners < chunk_corners)) {
        corners += 3 * primitive_triangles(document(), gltf_primitive(tasks[end].name));
        ++end;
    }
    return end;
}

Affined BatchReader::batch_from_mesh(BatchSpace space, const PlacedNode& from) const {
    const Affined& within = sources_.group_from_node[static_cast<size_t>(from.node)];
    if (space == BatchSpace::dynamic_group) return within;
    const std::vector<Affined>& anchors = *sources_.meshes.anchors;
    return compose(anchors[static_cast<size_t>(from.dynamic_group)],
                   compose(within, from.node_from_mesh));
}

Result<MeshPrimitive> BatchReader::read_task(BatchSpace space, const PrimitiveTask& task) const {
    PrimitivePose pose{task.use->weights, {}};
    if (task.use->skin >= 0) {
        pose.world_from_bind = sources_.skins[static_cast<size_t>(task.use->skin)];
    }
    Result<MeshPrimitive> primitive =
        read_mesh_primitive(document(), sources_.meshes.buffers, task.name, pose);
    if (!primitive || task.placed < 0 || primitive->in_world) return primitive;
    const PlacedNode& from = placed(task.placed);
    const bool world = space == BatchSpace::world;
    if (!bake_primitive(*primitive, world ? from.world_from_node : batch_from_mesh(space, from))) {
        return fail(ExitCode::bad_data,
                    "E-NODE-RANGE",
                    document().at("nodes", static_cast<size_t>(from.node)),
                    "the node moves vertices of primitive " + std::to_string(task.name.primitive) +
                        " of its mesh beyond 1e18");
    }
    return primitive;
}

Result<GeometryBatch> BatchReader::read(const MeshBatch& batch) {
    GeometryBatch out;
    out.stamp = batch.is_static ? new_geometry_stamp() : 0;
    const size_t first_corner = scene_.indices.size();
    const std::vector<PrimitiveTask>& tasks = batch.tasks;
    std::vector<std::optional<Result<MeshPrimitive>>> primitives;
    for (size_t begin = 0; begin < tasks.size();) {
        const size_t end = chunk_end(tasks, begin);
        primitives.clear();
        primitives.resize(end - begin);
        parallel_for(end - begin,
                     [&](size_t i) { primitives[i] = read_task(batch.space, tasks[begin + i]); });
        for (size_t i = 0; i < primitives.size(); ++i) {
            const PrimitiveTask& task = tasks[begin + i];
            Result<MeshPrimitive>& primitive = *primitives[i];
            if (primitive) {
                const Result<void> done = append(task, *primitive, out);
                if (!done) return fail(done.error());
            } else {
                problems_.add(primitive.error(), {Loss::primitive, "the primitive is not drawn"});
                use_material(task.name);
                out.faulty = true;
            }
            primitives[i].reset();
        }
        begin = end;
    }
    out.triangles = (scene_.indices.size() - first_corner) / 3;
    out.end = {scene_.positions.size(), scene_.indices.size(), scene_.attributes.size()};
    return out;
}

/// Strict loading also lists the faults of images that only faulty primitives use.
void BatchReader::use_material(const PrimitiveName& name) {
    if (problems_.lenient()) return;
    materials_.used[static_cast<size_t>(gltf_primitive(name).material) + 1] = 1;
}

int BatchReader::choose_material(const PrimitiveNote& note) {
    const int material = gltf_primitive(note.name).material;
    const MaterialChoice choice =
        note.corners == 3 ? material_for_surface(materials_, material, note.uv_sets)
                          : material_for_points_lines(materials_, material, note.shading);
    if (choice.lost.empty()) return choice.index;
    const std::string text = lost_slots_text(materials_, choice);
    if (note.corners == 3) {
        problems_.add(
            {ExitCode::bad_data, "E-MESH-TEXCOORD", place(note.name), text + "; it must have them"},
            {Loss::nothing, "there the factors alone count"});
    } else if (choice.is_new) {
        log_.warn(place(note.name), text + "; there the factors alone count");
    }
    return choice.index;
}

Result<void> BatchReader::append(const PrimitiveTask& task,
                                 MeshPrimitive& primitive,
                                 GeometryBatch& to) {
    PrimitiveNote note = note_of(task, primitive);
    note.node = node_of(task);
    note.needs = material_needs(document(), gltf_primitive(task.name).material);
    note_issues(note);
    note_faults(primitive);
    to.faulty = to.faulty || !primitive.faults.empty();
    to.notes.push_back(note);
    if (primitive.indices.empty()) {
        if (!primitive.faults.empty()) use_material(task.name);
        return {};
    }
    if (document().from_rec709) convert_colors(*document().from_rec709, primitive.colors, 4);
    GeometryStore* store = sources_.meshes.store;
    SphereOrders* orders = store != nullptr ? &store->sphere_orders : nullptr;
    Result<Primitive> appended =
        primitive.corners == 3 ? append_primitive(scene_, primitive, place(task.name))
                               : append_points_lines(scene_, primitive, place(task.name), orders);
    if (!appended) return fail(std::move(appended.error()));
    if (appended->triangle_count == 0) return {};  // lines of no length
    to.notes.back().drawn = true;
    appended->material = choose_material(note);
    appended->node = note.node;
    to.primitives.push_back(*appended);
    for (const uint32_t vertex : primitive.indices) {
        const float* p = &primitive.positions[3 * static_cast<size_t>(vertex)];
        grow(to.box, {p[0], p[1], p[2]});
    }
    return {};
}

bool BatchReader::is_same(const GeometryBatch& kept, const MeshBatch& batch) const {
    const auto same = [&](const PrimitiveNote& note, const PrimitiveTask& task) {
        return note.name.mesh == task.name.mesh && note.name.primitive == task.name.primitive &&
               note.node == node_of(task) &&
               have_same_needs(note.needs,
                               material_needs(document(), gltf_primitive(note.name).material));
    };
    return batch.is_static && !kept.faulty &&
           std::equal(
               kept.notes.begin(), kept.notes.end(), batch.tasks.begin(), batch.tasks.end(), same);
}

void BatchReader::use_again(GeometryBatch& kept) {
    size_t index = 0;
    for (const PrimitiveNote& note : kept.notes) {
        note_issues(note);
        if (note.drawn) kept.primitives[index++].material = choose_material(note);
    }
}

void BatchReader::note_faults(const MeshPrimitive& primitive) {
    const char* const what = primitive.corners == 3   ? " triangles"
                             : primitive.corners == 2 ? " line segments"
                                                      : " points";
    for (const PrimitiveFault& fault : primitive.faults) {
        const std::string count = std::to_string(fault.dropped) + what;
        problems_.add(fault.error, {Loss::triangle, count + " are left out", fault.dropped});
    }
}

void BatchReader::note_issues(const PrimitiveNote& note) {
    for (uint32_t i = 0; i < static_cast<uint32_t>(MeshIssue::count); ++i) {
        const MeshIssue issue = static_cast<MeshIssue>(i);
        if ((note.issues & issue_bit(issue)) == 0) continue;
        issues_[issue].add(document().meshes[static_cast<size_t>(note.name.mesh)].name);
    }
}

}  // namespace obscura::gltf
