// gltf/geometry/block_reader.cpp - reads the primitives of a block behind the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/block_reader.h"

#include "base/parallel.h"
#include "gltf/geometry/mesh_append.h"
#include "gltf/geometry/strokes.h"

#include <algorithm>
#include <optional>

namespace obscura {

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

PartNote note_of(const PartJob& job, const MeshPart& part) {
    PartNote out;
    out.name = job.name;
    out.corners = part.corners;
    out.issues = part.issues;
    for (size_t set = 0; set < part.uvs.size(); ++set) {
        if (!part.uvs[set].empty()) out.uv_sets |= 1U << set;
    }
    out.look = {!part.normals.empty(), out.uv_sets};
    return out;
}

}  // namespace

std::string BlockReader::place(const PartName& name) const {
    return document().at("meshes", static_cast<size_t>(name.mesh)) + "/primitives/" +
           std::to_string(name.primitive);
}

/// Parts are read in batches: together on all cores, but never all in memory twice.
size_t BlockReader::batch_end(const std::vector<PartJob>& jobs, size_t begin) const {
    constexpr uint64_t batch_corners = 3U << 20;
    uint64_t corners = 0;
    size_t end = begin;
    while (end < jobs.size() && (end == begin || corners < batch_corners)) {
        corners += 3 * primitive_triangles(document(), primitive(jobs[end].name));
        ++end;
    }
    return end;
}

Affined BlockReader::block_from_mesh(BlockSpace space, const PlacedNode& from) const {
    const Affined& within = sources_.mover_from_node[static_cast<size_t>(from.node)];
    if (space == BlockSpace::mover) return within;
    const std::vector<Affined>& anchors = *sources_.meshes.anchors;
    return compose(anchors[static_cast<size_t>(from.mover)], compose(within, from.node_from_mesh));
}

Result<MeshPart> BlockReader::read_job(BlockSpace space, const PartJob& job) const {
    PartPose pose{job.use->weights, {}};
    if (job.use->skin >= 0) {
        pose.world_from_bind = sources_.skins[static_cast<size_t>(job.use->skin)];
    }
    Result<MeshPart> part = read_mesh_part(document(), sources_.meshes.buffers, job.name, pose);
    if (!part || job.placed < 0 || part->in_world) return part;
    const PlacedNode& from = placed(job.placed);
    const bool world = space == BlockSpace::world;
    if (!bake_part(*part, world ? from.world_from_node : block_from_mesh(space, from))) {
        return fail(ExitCode::bad_data,
                    "E-NODE-RANGE",
                    document().at("nodes", static_cast<size_t>(from.node)),
                    "the node moves vertices of primitive " + std::to_string(job.name.primitive) +
                        " of its mesh beyond 1e18");
    }
    return part;
}

Result<GeometryBlock> BlockReader::read(const MeshBlock& block) {
    GeometryBlock out;
    out.stamp = block.keeps ? new_geometry_stamp() : 0;
    const size_t first_corner = scene_.indices.size();
    const std::vector<PartJob>& jobs = block.jobs;
    std::vector<std::optional<Result<MeshPart>>> parts;
    for (size_t begin = 0; begin < jobs.size();) {
        const size_t end = batch_end(jobs, begin);
        parts.clear();
        parts.resize(end - begin);
        parallel_for(end - begin,
                     [&](size_t i) { parts[i] = read_job(block.space, jobs[begin + i]); });
        for (size_t i = 0; i < parts.size(); ++i) {
            const PartJob& job = jobs[begin + i];
            Result<MeshPart>& part = *parts[i];
            if (part) {
                const Result<void> done = append(job, *part, out);
                if (!done) return fail(done.error());
            } else {
                problems_.add(part.error(), {Loss::primitive, "the primitive is not drawn"});
                use_material(job.name);
                out.faulty = true;
            }
            parts[i].reset();
        }
        begin = end;
    }
    out.triangles = (scene_.indices.size() - first_corner) / 3;
    out.end = {scene_.positions.size(), scene_.indices.size(), scene_.attributes.size()};
    return out;
}

/// Strict loading lists the faults of images too that only faulty primitives show.
void BlockReader::use_material(const PartName& name) {
    if (problems_.lenient()) return;
    materials_.used[static_cast<size_t>(primitive(name).material) + 1] = 1;
}

int BlockReader::choose_material(const PartNote& note) {
    const int material = primitive(note.name).material;
    const MaterialChoice choice = note.corners == 3
                                      ? material_row(materials_, material, note.uv_sets)
                                      : stroke_material_row(materials_, material, note.look);
    if (choice.lost.empty()) return choice.row;
    const std::string text = lost_slots_text(materials_, choice);
    if (note.corners == 3) {
        problems_.add(
            {ExitCode::bad_data, "E-MESH-TEXCOORD", place(note.name), text + "; it must have them"},
            {Loss::nothing, "there the factors alone count"});
    } else if (choice.is_new) {
        log_.warn(place(note.name), text + "; there the factors alone count");
    }
    return choice.row;
}

Result<void> BlockReader::append(const PartJob& job, MeshPart& part, GeometryBlock& to) {
    PartNote note = note_of(job, part);
    note.node = node_of(job);
    note.needs = material_needs(document(), this->primitive(job.name).material);
    note_issues(note);
    note_faults(part);
    to.faulty = to.faulty || !part.faults.empty();
    to.notes.push_back(note);
    if (part.indices.empty()) {
        if (!part.faults.empty()) use_material(job.name);
        return {};
    }
    GeometryStore* store = sources_.meshes.store;
    SphereOrders* orders = store != nullptr ? &store->sphere_orders : nullptr;
    Result<Primitive> primitive = part.corners == 3
                                      ? append_part(scene_, part, place(job.name))
                                      : append_strokes(scene_, part, place(job.name), orders);
    if (!primitive) return fail(std::move(primitive.error()));
    if (primitive->triangle_count == 0) return {};  // lines of no length
    to.notes.back().drawn = true;
    primitive->material = choose_material(note);
    primitive->node = note.node;
    to.primitives.push_back(*primitive);
    for (const uint32_t vertex : part.indices) {
        const float* p = &part.positions[3 * static_cast<size_t>(vertex)];
        grow(to.box, {p[0], p[1], p[2]});
    }
    return {};
}

bool BlockReader::is_same(const GeometryBlock& kept, const MeshBlock& block) const {
    const auto same = [&](const PartNote& note, const PartJob& job) {
        return note.name.mesh == job.name.mesh && note.name.primitive == job.name.primitive &&
               note.node == node_of(job) &&
               have_same_needs(note.needs,
                               material_needs(document(), primitive(note.name).material));
    };
    return block.keeps && !kept.faulty &&
           std::equal(
               kept.notes.begin(), kept.notes.end(), block.jobs.begin(), block.jobs.end(), same);
}

void BlockReader::use_again(GeometryBlock& kept) {
    size_t row = 0;
    for (const PartNote& note : kept.notes) {
        note_issues(note);
        if (note.drawn) kept.primitives[row++].material = choose_material(note);
    }
}

void BlockReader::note_faults(const MeshPart& part) {
    const char* const what = part.corners == 3   ? " triangles"
                             : part.corners == 2 ? " pieces of lines"
                                                 : " points";
    for (const PartFault& fault : part.faults) {
        const std::string count = std::to_string(fault.dropped) + what;
        problems_.add(fault.error, {Loss::triangle, count + " are left out", fault.dropped});
    }
}

void BlockReader::note_issues(const PartNote& note) {
    for (uint32_t i = 0; i < static_cast<uint32_t>(MeshIssue::count); ++i) {
        const MeshIssue issue = static_cast<MeshIssue>(i);
        if ((note.issues & issue_bit(issue)) == 0) continue;
        issues_[issue].add(document().meshes[static_cast<size_t>(note.name.mesh)].name);
    }
}

}  // namespace obscura
