// gltf/meshes.cpp - the meshes of the chosen scene become arrays, baked to the world or instanced.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/meshes.h"

#include "base/parallel.h"
#include "gltf/list_text.h"
#include "gltf/mesh_uses.h"
#include "gltf/primitive_modes.h"
#include "gltf/skins.h"
#include "gltf/strokes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace obscura {

namespace {

constexpr double farthest_position = 1e18;

/// One primitive to be read; baked to the world when `placed` is not -1.
struct PartJob {
    PartName name;
    const MeshUse* use = nullptr;
    int placed = -1;
};

class MeshBuilder {
public:
    MeshBuilder(const MeshSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log)
        : sources_(sources), materials_(materials), problems_(problems), scene_(scene), log_(log) {}

    Result<void> build();

private:
    const Document& document() const { return sources_.document; }
    const PlacedNode& placed(int index) const {
        return sources_.placed[static_cast<size_t>(index)];
    }
    const GltfMesh& mesh(int index) const { return document().meshes[static_cast<size_t>(index)]; }

    std::string place(const PartJob& job) const {
        return document().at("meshes", static_cast<size_t>(job.name.mesh)) + "/primitives/" +
               std::to_string(job.name.primitive);
    }

    void find_uses();
    void drop_uses(int skin, const Error& error);
    enum class JobKind { triangles, strokes };
    void add_jobs(const MeshUse& use,
                  int placed_index,
                  JobKind kind,
                  std::vector<PartJob>& jobs) const;
    void reserve(const std::vector<PartJob>& jobs);
    size_t batch_end(const std::vector<PartJob>& jobs, size_t begin) const;
    Result<void> run(const std::vector<PartJob>& jobs);
    Result<MeshPart> read_job(const PartJob& job) const;
    Result<void> append(const PartJob& job, const MeshPart& part);
    Result<void> build_shared(const MeshUse& use);
    void add_instance(int mesh_row, int placed_index, const Bounds& box, size_t triangles);
    void use_material(const PartJob& job);
    int choose_material(const PartJob& job, const MeshPart& part);
    void note_faults(const MeshPart& part);
    void note_issues(const PartJob& job, const MeshPart& part);
    void warn();

    const MeshSources& sources_;
    MaterialTable& materials_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    std::vector<MeshUse> uses_;                ///< in the order they are met
    std::vector<std::vector<Affined>> skins_;  ///< matrices; empty: no mesh that is drawn has it
    Bounds part_bounds_;                       ///< grows while parts are appended
    std::map<MeshIssue, NameList> issues_;
    NameList flat_nodes_;
};

void grow(Bounds& bounds, const Vec3f& p) {
    bounds.low = {
        std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y), std::min(bounds.low.z, p.z)};
    bounds.high = {
        std::max(bounds.high.x, p.x), std::max(bounds.high.y, p.y), std::max(bounds.high.z, p.z)};
}

void MeshBuilder::drop_uses(int skin, const Error& error) {
    size_t lost = 0;
    std::erase_if(uses_, [&](const MeshUse& use) {
        const bool drops = use.skin == skin;
        if (drops) lost += mesh(use.mesh).primitives.size();
        return drops;
    });
    problems_.add(error, {Loss::primitive, "meshes with the skin are not drawn", lost});
}

void MeshBuilder::find_uses() {
    MeshUses found = find_mesh_uses(document(), sources_.placed);
    uses_ = std::move(found.uses);
    for (const std::string& name : found.flat_nodes)
        flat_nodes_.add(name);
    skins_.resize(document().skins.size());
    std::vector<Affined> world_from_node;
    for (size_t i = 0; i < skins_.size(); ++i) {
        const int skin = static_cast<int>(i);
        const auto has_it = [&](const MeshUse& use) { return use.skin == skin; };
        if (std::none_of(uses_.begin(), uses_.end(), has_it)) continue;
        if (world_from_node.empty()) world_from_node = world_transforms(document());
        Result<std::vector<Affined>> matrices =
            skin_matrices(document(), sources_.buffers, world_from_node, skin);
        if (matrices) skins_[i] = std::move(*matrices);
        if (!matrices) drop_uses(skin, matrices.error());
    }
}

void MeshBuilder::add_jobs(const MeshUse& use,
                           int placed_index,
                           JobKind kind,
                           std::vector<PartJob>& jobs) const {
    const std::vector<GltfPrimitive>& primitives = mesh(use.mesh).primitives;
    for (size_t i = 0; i < primitives.size(); ++i) {
        const bool strokes = is_point_or_line_mode(primitives[i].mode);
        if (strokes != (kind == JobKind::strokes)) continue;
        jobs.push_back({{use.mesh, static_cast<int>(i)}, &use, placed_index});
    }
}

/// Room for what the jobs will add, as far as the accessors' counts tell.
void MeshBuilder::reserve(const std::vector<PartJob>& jobs) {
    size_t vertices = 0;
    size_t corners = 0;
    size_t floats = 0;
    for (const PartJob& job : jobs) {
        const GltfPrimitive& primitive =
            mesh(job.name.mesh).primitives[static_cast<size_t>(job.name.primitive)];
        if (primitive.position < 0) continue;
        const size_t triangles = primitive_triangles(document(), primitive);
        const size_t count = std::min(
            document().accessors[static_cast<size_t>(primitive.position)].count, triangles * 3);
        const MaterialNeeds needs = material_needs(document(), primitive.material);
        const int sets = __builtin_popcount(needs.uv_sets);
        const int tangents = needs.tangents ? 4 : 0;
        const int width =
            2 * sets + tangents + (primitive.normal >= 0 ? 3 : 0) + (primitive.color >= 0 ? 4 : 0);
        vertices += count;
        corners += triangles * 3;
        floats += count * static_cast<size_t>(width);
    }
    constexpr size_t most = 1U << 31;
    scene_.positions.reserve(std::min(most, scene_.positions.size() + vertices * 3 + 4));
    scene_.indices.reserve(std::min(most, scene_.indices.size() + corners + 1));
    scene_.attributes.reserve(std::min(most, scene_.attributes.size() + floats + 4));
}

/// Parts are read in batches: together on all cores, but never all in memory twice.
size_t MeshBuilder::batch_end(const std::vector<PartJob>& jobs, size_t begin) const {
    constexpr uint64_t batch_corners = 3U << 20;
    uint64_t corners = 0;
    size_t end = begin;
    while (end < jobs.size() && (end == begin || corners < batch_corners)) {
        const PartName& name = jobs[end].name;
        corners +=
            3 * primitive_triangles(
                    document(), mesh(name.mesh).primitives[static_cast<size_t>(name.primitive)]);
        ++end;
    }
    return end;
}

Result<MeshPart> MeshBuilder::read_job(const PartJob& job) const {
    PartPose pose{job.use->weights, {}};
    if (job.use->skin >= 0) pose.world_from_bind = skins_[static_cast<size_t>(job.use->skin)];
    Result<MeshPart> part = read_mesh_part(document(), sources_.buffers, job.name, pose);
    if (!part || job.placed < 0 || part->in_world) return part;
    const PlacedNode& place = placed(job.placed);
    if (!bake_part(*part, place.world_from_node)) {
        return fail(ExitCode::bad_data,
                    "E-NODE-RANGE",
                    document().at("nodes", static_cast<size_t>(place.node)),
                    "the node moves vertices of primitive " + std::to_string(job.name.primitive) +
                        " of its mesh beyond 1e18");
    }
    return part;
}

Result<void> MeshBuilder::run(const std::vector<PartJob>& jobs) {
    std::vector<std::optional<Result<MeshPart>>> parts;
    for (size_t begin = 0; begin < jobs.size();) {
        const size_t end = batch_end(jobs, begin);
        parts.clear();
        parts.resize(end - begin);
        parallel_for(end - begin, [&](size_t i) { parts[i] = read_job(jobs[begin + i]); });
        for (size_t i = 0; i < parts.size(); ++i) {
            Result<MeshPart>& part = *parts[i];
            if (part) {
                const Result<void> done = append(jobs[begin + i], *part);
                if (!done) return done;
            } else {
                problems_.add(part.error(), {Loss::primitive, "the primitive is not drawn"});
                use_material(jobs[begin + i]);
            }
            parts[i].reset();
        }
        begin = end;
    }
    return {};
}

/// Strict loading lists the faults of images too that only faulty primitives show.
void MeshBuilder::use_material(const PartJob& job) {
    if (problems_.lenient()) return;
    const auto primitive = static_cast<size_t>(job.name.primitive);
    const int material = mesh(job.name.mesh).primitives[primitive].material;
    materials_.used[static_cast<size_t>(material) + 1] = 1;
}

int MeshBuilder::choose_material(const PartJob& job, const MeshPart& part) {
    uint32_t uv_sets = 0;
    for (size_t set = 0; set < part.uvs.size(); ++set) {
        if (!part.uvs[set].empty()) uv_sets |= 1U << set;
    }
    const int material =
        mesh(job.name.mesh).primitives[static_cast<size_t>(job.name.primitive)].material;
    const MaterialChoice choice = material_row(materials_, material, uv_sets);
    if (choice.lost.empty()) return choice.row;
    const std::string text = lost_slots_text(materials_, choice);
    if (part.corners == 3) {
        problems_.add(
            {ExitCode::bad_data, "E-MESH-TEXCOORD", place(job), text + "; it must have them"},
            {Loss::nothing, "there the factors alone count"});
    } else if (choice.is_new) {  // points and lines have no textures
        log_.warn(place(job), text + "; there the factors alone count");
    }
    return choice.row;
}

Result<void> MeshBuilder::append(const PartJob& job, const MeshPart& part) {
    note_issues(job, part);
    note_faults(part);
    if (part.indices.empty()) {
        if (!part.faults.empty()) use_material(job);
        return {};
    }
    Result<Primitive> primitive = part.corners == 3 ? append_part(scene_, part, place(job))
                                                    : append_strokes(scene_, part, place(job));
    if (!primitive) return fail(std::move(primitive.error()));
    if (primitive->triangle_count == 0) return {};  // lines of no length
    primitive->material = choose_material(job, part);
    primitive->node = job.placed < 0 ? -1 : placed(job.placed).node;
    scene_.primitives.push_back(*primitive);
    for (const uint32_t vertex : part.indices) {
        const float* p = &part.positions[3 * static_cast<size_t>(vertex)];
        grow(part_bounds_, {p[0], p[1], p[2]});
    }
    return {};
}

Result<void> MeshBuilder::build_shared(const MeshUse& use) {
    std::vector<PartJob> jobs;
    add_jobs(use, -1, JobKind::triangles, jobs);
    Mesh row;
    row.first_primitive = static_cast<int32_t>(scene_.primitives.size());
    const size_t corners = scene_.indices.size();
    part_bounds_ = {};
    const Result<void> done = run(jobs);
    if (!done) return done;
    row.primitive_count = static_cast<int32_t>(scene_.primitives.size()) - row.first_primitive;
    if (row.primitive_count == 0) return {};
    const int mesh_row = static_cast<int>(scene_.meshes.size());
    scene_.meshes.push_back(row);
    const size_t triangles = (scene_.indices.size() - corners) / 3;
    for (const int placed_index : use.placed) {
        add_instance(mesh_row, placed_index, part_bounds_, triangles);
    }
    return {};
}

void MeshBuilder::add_instance(int mesh_row,
                               int placed_index,
                               const Bounds& box,
                               size_t triangles) {
    const PlacedNode& place = placed(placed_index);
    Instance instance;
    instance.world_from_object = affine_cast<float>(place.world_from_node);
    instance.object_from_world = affine_cast<float>(inverse(place.world_from_node));
    instance.mesh = mesh_row;
    instance.node = place.node;
    instance.mirrored = determinant(place.world_from_node) < 0 ? 1 : 0;
    bool in_range = true;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            in_range = in_range && std::isfinite(instance.world_from_object.m[r][c]) &&
                       std::isfinite(instance.object_from_world.m[r][c]);
        }
    }
    Bounds all = scene_.bounds;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p = {(corner & 1) != 0 ? box.high.x : box.low.x,
                         (corner & 2) != 0 ? box.high.y : box.low.y,
                         (corner & 4) != 0 ? box.high.z : box.low.z};
        const Vec3d moved = transform_point(place.world_from_node, p);
        in_range = in_range && max_component(abs(moved)) <= farthest_position;
        grow(all,
             {static_cast<float>(moved.x),
              static_cast<float>(moved.y),
              static_cast<float>(moved.z)});
    }
    if (!in_range) {
        const size_t lost =
            static_cast<size_t>(scene_.meshes[static_cast<size_t>(mesh_row)].primitive_count);
        problems_.add({ExitCode::bad_data,
                       "E-NODE-RANGE",
                       document().at("nodes", static_cast<size_t>(place.node)),
                       "the node moves vertices of its mesh beyond 1e18, or its scale is beyond "
                       "what single precision can invert"},
                      {Loss::primitive, "the mesh is not drawn there", lost});
        return;
    }
    scene_.bounds = all;
    scene_.instances.push_back(instance);
    scene_.info.triangles_in_world += triangles;
}

void MeshBuilder::note_faults(const MeshPart& part) {
    const char* const what = part.corners == 3   ? " triangles"
                             : part.corners == 2 ? " pieces of lines"
                                                 : " points";
    for (const PartFault& fault : part.faults) {
        const std::string count = std::to_string(fault.dropped) + what;
        problems_.add(fault.error, {Loss::triangle, count + " are left out", fault.dropped});
    }
}

void MeshBuilder::note_issues(const PartJob& job, const MeshPart& part) {
    for (uint32_t i = 0; i < static_cast<uint32_t>(MeshIssue::count); ++i) {
        const MeshIssue issue = static_cast<MeshIssue>(i);
        if ((part.issues & issue_bit(issue)) != 0) issues_[issue].add(mesh(job.name.mesh).name);
    }
}

void MeshBuilder::warn() {
    for (const auto& [issue, list] : issues_) {
        log_.warn(document().file,
                  std::string(mesh_issue_text(issue)) + "; meshes: " + list.text());
    }
    if (!flat_nodes_.empty()) {
        log_.warn(document().file,
                  "nodes whose scale is zero or whose matrix is singular are not drawn: " +
                      flat_nodes_.text());
    }
}

Result<void> MeshBuilder::build() {
    find_uses();
    std::vector<PartJob> world;
    for (const MeshUse& use : uses_) {
        if (use.placed.size() == 1) add_jobs(use, use.placed[0], JobKind::triangles, world);
        // Points and lines, whose radius no node may stretch: in the world wherever they are.
        for (const int placed_index : use.placed)
            add_jobs(use, placed_index, JobKind::strokes, world);
    }
    std::vector<PartJob> all = world;
    for (const MeshUse& use : uses_) {
        if (use.placed.size() == 1) continue;
        for (size_t i = 0; i < mesh(use.mesh).primitives.size(); ++i) {
            all.push_back({{use.mesh, static_cast<int>(i)}, &use, -1});
        }
    }
    reserve(all);
    Result<void> done = run(world);
    if (!done) return done;
    scene_.world_primitive_count = static_cast<int32_t>(scene_.primitives.size());
    scene_.info.triangles_in_world = scene_.indices.size() / 3;
    scene_.bounds = part_bounds_;
    for (const MeshUse& use : uses_) {
        if (use.placed.size() == 1) continue;
        done = build_shared(use);
        if (!done) return done;
    }
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

}  // namespace obscura
