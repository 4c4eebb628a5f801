// crosscheck/spawned.cpp - checks rays that shading starts: self-hits, and leaks at walls.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/spawned.h"

#include "base/parallel.h"
#include "crosscheck/compare.h"
#include "crosscheck/shape_side.h"
#include "render/prepared_scene.h"
#include "stages/wavefront.h"

#include <algorithm>
#include <functional>
#include <mutex>

namespace obscura::crosscheck {

namespace {

constexpr double wall_gap = 1e-4;  ///< of the scene's size
constexpr int wall_scenes = 8;
/// Passes over the rays, with other spawned directions each, until enough are spawned.
constexpr uint64_t max_passes = 8;

/// Traces a block of rays and lets the stage start one ray at every hit.
class Spawner {
public:
    explicit Spawner(const PreparedScene& scene) : scene_(scene) {
        wavefront_.stages = scene.impl().stages;
        wavefront_.accel = &scene.accel();
        wavefront_.scene = scene.impl().view();
        wavefront_.batch.ao_distance = 3e38f;
    }

    /// starts[slot] is where the spawned ray with that sample index started. Returns their number.
    int spawn(RayBlock& rays, uint32_t key, Workspace& work, std::vector<Answer>& starts) const {
        const PathColumns& p = work.paths[0];
        for (int i = 0; i < rays.count(); ++i) {
            const Vec3f o = rays.origin(i);
            const Vec3f d = rays.direction(i);
            p.ox[i] = o.x;
            p.oy[i] = o.y;
            p.oz[i] = o.z;
            p.dx[i] = d.x;
            p.dy[i] = d.y;
            p.dz[i] = d.z;
            p.tr[i] = p.tg[i] = p.tb[i] = 1.0f;
            p.pdf[i] = p.cone_width[i] = p.cone_spread[i] = 0.0f;
            p.slot[i] = static_cast<uint32_t>(i);
            p.key[i] = hash_word(key + static_cast<uint32_t>(i));
            p.path_key[i] = p.key[i];
            p.sample[i] = 0U;
        }
        scene_.accel().intersect(rays_of(p, rays.count()), work.hits, Coherence::incoherent, {});
        starts.clear();
        for (int i = 0; i < rays.count(); ++i) {
            const HitColumns& h = work.hits;
            starts.push_back(
                {static_cast<double>(h.t[i]), {h.instance[i], h.primitive[i], h.triangle[i]}});
        }
        return spawn_ambient_rays(wavefront_, rays.count(), work);
    }

    const PreparedScene& scene() const { return scene_; }

private:
    const PreparedScene& scene_;
    WavefrontInput wavefront_{};
};

/// A Workspace for each thread, made at first use.
class Workspaces {
public:
    Workspace& mine() {
        auto& own = all_[thread_index()];
        if (!own) own = std::make_unique<Workspace>();
        return *own;
    }

private:
    std::vector<std::unique_ptr<Workspace>> all_ =
        std::vector<std::unique_ptr<Workspace>>(max_thread_index());
};

RayBlock shadows_as_rays(const Workspace& work, int count) {
    RayBlock out;
    const ShadowColumns& s = work.shadows;
    for (int i = 0; i < count; ++i) {
        out.add({s.ox[i], s.oy[i], s.oz[i]}, {s.dx[i], s.dy[i], s.dz[i]});
    }
    return out;
}

/// A hit of a ray on a shape.
struct ShapeMeeting {
    const TrueRay& ray;
    double t;
};

/// True where the ray meets the shape's front, by the root closest to t.
bool meets_front(const TrueScene& truth, const Item& item, const ShapeMeeting& meeting) {
    const Affined object = truth.object_from_world(item);
    const ShapeRecord record = truth.shape(item);
    const ShapeRay<double> own{transform_point(object, meeting.ray.origin),
                               transform_vector(object, meeting.ray.direction)};
    const Roots<double> roots = intersect_shape<double>(record, own);
    const auto distance = [&](int k) {
        return roots.hit[k] ? std::abs(roots.t[k] - meeting.t) : INFINITY;
    };
    const int k = distance(1) < distance(0) ? 1 : 0;
    return is_front<double>(record, own, roots.t[k], k);
}

/// Below this cosine, rounding decides on which side a ray meets a shape.
constexpr double min_cosine = 1e-3;

/// True when a spawned ray may hit its own item again: the side that it meets must be the one that
/// it left, which is never so for flat items.
bool is_true_return(const TrueScene& truth,
                    const Item& item,
                    const ShapeMeeting& before,
                    const ShapeMeeting& after) {
    if (truth.is_triangle(item)) return false;
    const double cosine =
        dot(truth.normal(item, after.ray.origin), normalize(before.ray.direction));
    if (std::abs(cosine) < min_cosine) return !is_flat(truth.shape(item));
    // The side that was left: as the ray met it, or as the normal is where the spawned ray starts.
    // Far away, and at the edges of boxes, only one of them is right.
    const bool meets = meets_front(truth, item, after);
    return meets == meets_front(truth, item, before) || meets == (cosine < 0);
}

/// Counts of one chunk, merged under a lock; the first ray is the one with the lowest number.
struct SpawnedSum {
    uint64_t rays = 0, faults = 0;
    uint64_t first_number = UINT64_MAX;
    std::optional<TrueRay> first;

    void fault(uint64_t number, const TrueRay& ray) {
        ++faults;
        if (number >= first_number) return;
        first_number = number;
        first = ray;
    }
    void add(const SpawnedSum& other) {
        rays += other.rays;
        faults += other.faults;
        if (other.first_number >= first_number) return;
        first_number = other.first_number;
        first = other.first;
    }
};

/// Self-hits of one pass over the rays, of the aimed or of the unaimed half.
SpawnedSum self_hits(
    const Spawner& spawner, const TrueScene& truth, const RaySet& rays, uint64_t pass, bool aimed) {
    Workspaces workspaces;
    const uint64_t before = pass * rays.count();
    SpawnedSum all;
    std::mutex merging;
    parallel_for(rays.chunks(), [&](size_t chunk) {
        if (is_unaimed(RaySet::group(chunk)) == aimed) return;
        RayBlock block;
        std::vector<Answer> starts;
        HitBlock hits;
        Workspace& work = workspaces.mine();
        rays.fill(chunk, block);
        const uint64_t first = before + chunk * chunk_rays;
        const int count = spawner.spawn(block, static_cast<uint32_t>(first), work, starts);
        RayBlock spawned = shadows_as_rays(work, count);
        const RayColumns columns = spawned.columns();
        spawner.scene().accel().intersect(columns, hits.columns(count), Coherence::incoherent, {});
        SpawnedSum mine;
        mine.rays = static_cast<uint64_t>(count);
        for (int i = 0; i < count; ++i) {
            const uint32_t slot = work.shadows.slot[i];
            const Answer& start = starts[slot];
            if (hits.item(i).primitive < 0 || hits.item(i) != start.item) continue;
            const TrueRay camera = block.true_ray(static_cast<int>(slot));
            const TrueRay ray = spawned.true_ray(i);
            const auto t = static_cast<double>(hits.t(i));
            if (is_true_return(truth, start.item, {camera, start.t}, {ray, t})) continue;
            mine.fault(first + static_cast<uint64_t>(i), ray);
        }
        const std::lock_guard lock(merging);
        all.add(mine);
    });
    return all;
}

/// Two parallel sheets, the upper one ten times as wide; `size` is the scene's.
struct Wall {
    Vec3d centre, along, across, normal;
    double size;

    Vec3d at(double u, double v, double height) const {
        return centre + (along * u + across * v + normal * (height * wall_gap)) * size;
    }
};

Wall random_wall(const TrueBox& box, RandomStream& random) {
    const Vec3d half = (box.high - box.low) * 0.5;
    Wall wall;
    wall.size = 2 * length(half);
    wall.centre = box.low + half +
                  half * Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    wall.normal = random.direction();
    const Frame<double> frame = frame_around(wall.normal);
    wall.along = frame.tangent;
    wall.across = frame.bitangent;
    return wall;
}

/// The wall as two quads: in the world, or in a mesh of size 1 that an instance moves and scales.
Scene wall_scene(const Wall& wall, bool instanced) {
    Scene scene;
    scene.materials.emplace_back();
    scene.materials.back().flags |= material_double_sided;
    scene.material_names.emplace_back();
    scene.material_numbers.push_back(-1);
    Wall own = wall;
    if (instanced) own = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1};
    for (int sheet = 0; sheet < 2; ++sheet) {
        const double half = sheet == 0 ? 0.05 : 0.5;
        const auto first = static_cast<uint32_t>(scene.positions.size() / 3);
        for (int k = 0; k < 4; ++k) {
            const Vec3d p = own.at(k == 0 || k == 3 ? -half : half, k < 2 ? -half : half, sheet);
            for (const double c : {p.x, p.y, p.z})
                scene.positions.push_back(static_cast<float>(c));
        }
        for (const uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U})
            scene.indices.push_back(first + k);
    }
    Primitive primitive;
    primitive.triangle_count = 4;
    scene.primitives.push_back(primitive);
    scene.world_primitive_count = instanced ? 0 : 1;
    if (instanced) {
        Affined transform;
        const Vec3d column[4] = {
            wall.along * wall.size, wall.across * wall.size, wall.normal * wall.size, wall.centre};
        for (int c = 0; c < 4; ++c) {
            transform.m[0][c] = column[c].x;
            transform.m[1][c] = column[c].y;
            transform.m[2][c] = column[c].z;
        }
        Instance instance;
        instance.world_from_object = affine_cast<float>(transform);
        instance.object_from_world =
            affine_cast<float>(inverse(affine_cast<double>(instance.world_from_object)));
        scene.meshes.push_back({0, 1});
        scene.instances.push_back(instance);
    }
    pad_tables(scene);
    return scene;
}

/// Rays from between the sheets down to the lower one; what shading starts there must be occluded,
/// wherever a search in double finds the upper sheet.
SpawnedSum wall_leaks(const Spawner& spawner, const Wall& wall, uint64_t rays, uint64_t first) {
    const TrueScene truth(spawner.scene().scene());
    Workspaces workspaces;
    SpawnedSum all;
    std::mutex merging;
    parallel_for(static_cast<size_t>((rays + chunk_rays - 1) / chunk_rays), [&](size_t chunk) {
        RayBlock block;
        std::vector<Answer> starts;
        Workspace& work = workspaces.mine();
        const uint64_t begin = first + chunk * chunk_rays;
        for (uint64_t i = begin; i < begin + chunk_rays; ++i) {
            RandomStream random(i);
            const auto inside = [&] { return random.between(-0.049, 0.049); };
            const Vec3d origin = wall.at(inside(), inside(), 0.5);
            block.add(origin, normalize(wall.at(inside(), inside(), 0) - origin));
        }
        const int count = spawner.spawn(block, static_cast<uint32_t>(begin), work, starts);
        RayBlock spawned = shadows_as_rays(work, count);
        std::vector<uint8_t> occluded(static_cast<size_t>(count) + 16);
        spawner.scene().accel().occluded(spawned.columns(), occluded.data(), Coherence::incoherent);
        SpawnedSum mine;
        for (int i = 0; i < count; ++i) {
            const TrueRay ray = spawned.true_ray(i);
            if (!truth.nearest(ray).found()) continue;
            ++mine.rays;
            if (occluded[static_cast<size_t>(i)] == 0) {
                mine.fault(begin + static_cast<uint64_t>(i), ray);
            }
        }
        const std::lock_guard lock(merging);
        all.add(mine);
    });
    return all;
}

}  // namespace

Result<SpawnedReport> check_spawned(const PreparedScene& scene,
                                    const TrueScene& truth,
                                    const RaySet& rays,
                                    Isa isa) {
    SpawnedReport report;
    const Spawner spawner(scene);
    SpawnedSum own;
    for (uint64_t pass = 0; pass < max_passes && own.rays < rays.count(); ++pass)
        own.add(self_hits(spawner, truth, rays, pass, false));
    const SpawnedSum aimed = self_hits(spawner, truth, rays, 0, true);
    report.rays = own.rays;
    report.self_hits = own.faults;
    report.aimed_rays = aimed.rays;
    report.aimed_self_hits = aimed.faults;
    report.first_self_hit = own.first ? own.first : aimed.first;
    SpawnedSum walls;
    Log silent(Verbosity::quiet);
    const TrueBox box = truth.bounds();
    if (!(box.low.x <= box.high.x)) return report;
    for (int i = 0; i < wall_scenes; ++i) {
        RandomStream random(static_cast<uint64_t>(i));
        const Wall wall = random_wall(box, random);
        const auto prepared = PreparedScene::create(wall_scene(wall, i % 2 == 1), {}, isa, silent);
        if (!prepared) return fail(prepared.error());
        const uint64_t share = rays.count() / wall_scenes + 1;
        walls.add(wall_leaks(Spawner(*prepared), wall, share, static_cast<uint64_t>(i) << 40));
    }
    report.wall_rays = walls.rays;
    report.wall_leaks = walls.faults;
    report.first_wall_leak = walls.first;
    return report;
}

}  // namespace obscura::crosscheck
