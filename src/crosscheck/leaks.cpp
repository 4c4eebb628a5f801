// crosscheck/leaks.cpp - shoots rays from inside closed meshes and shapes and counts leaks.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/leaks.h"

#include "accel/reference_kernels.h"
#include "base/parallel.h"
#include "crosscheck/ray_set.h"

#include <algorithm>
#include <functional>
#include <mutex>

namespace obscura::crosscheck {

namespace {

constexpr size_t points_wanted = 1024;
/// A point inside is at least so many ulp from the surface along the ray that found it.
constexpr double clearance_ulps = 64;

std::vector<double> sorted_hits(const TrueScene& component, const TrueRay& ray) {
    std::vector<double> hits;
    component.all_hits(ray, [&](double t, const Item&) { hits.push_back(t); });
    std::sort(hits.begin(), hits.end());
    return hits;
}

using FindHits = std::function<void(const RayColumns&, const HitColumns&)>;

/// One component, what is inside of it, and how many rays it gets.
struct Room {
    const TrueScene& component;
    const std::vector<Vec3d>& points;
    uint64_t rays;
    LeakAim aim;
    uint64_t seed;
};

void fill_rays(const Room& room, uint64_t first, uint64_t count, RayBlock& out) {
    out.clear();
    for (uint64_t i = first; i < first + count; ++i) {
        RandomStream random((i * 4 + static_cast<uint64_t>(room.aim)) ^ (room.seed << 40));
        const Vec3d& origin = room.points[random.below(room.points.size())];
        if (room.aim == LeakAim::anywhere) {
            out.add(origin, random.direction());
            continue;
        }
        const Item item = room.component.item(random.below(room.component.item_count()));
        const Triangle<double> t = room.component.triangle(item);
        const double along = room.aim == LeakAim::vertices ? 0 : random.unit();
        const Vec3d corner[3] = {t.a, t.b, t.c};
        const size_t k = random.below(3);
        const Vec3d target = corner[k] + (corner[(k + 1) % 3] - corner[k]) * along;
        out.add(origin, normalize(target - origin));
    }
}

void shoot(const Room& room, const FindHits& ask, LeakFigures& figures) {
    std::mutex merging;
    uint64_t first_leak = room.rays;
    LeakCount sum;
    const uint64_t chunk = 16 * chunk_rays;
    parallel_for(static_cast<size_t>((room.rays + chunk - 1) / chunk), [&](size_t number) {
        const uint64_t begin = number * chunk;
        const uint64_t count = std::min(chunk, room.rays - begin);
        RayBlock rays;
        HitBlock hits;
        fill_rays(room, begin, count, rays);
        const RayColumns columns = rays.columns();
        ask(columns, hits.columns(columns.count));
        uint64_t leaks = 0;
        uint64_t first = room.rays;
        for (int i = 0; i < columns.count; ++i) {
            if (hits.item(i).primitive >= 0) continue;
            if (leaks++ == 0) first = begin + static_cast<uint64_t>(i);
        }
        const std::lock_guard lock(merging);
        sum.rays += count;
        sum.leaks += leaks;
        first_leak = std::min(first_leak, first);
    });
    LeakCount& total = figures.by_aim[static_cast<size_t>(room.aim)];
    total.rays += sum.rays;
    total.leaks += sum.leaks;
    if (sum.leaks == 0 || figures.first) return;
    RayBlock one;
    fill_rays(room, first_leak, 1, one);
    figures.first = one.true_ray(0);
}

struct LeakKernel {
    const char* name;
    bool in_budget;
    FindHits ask;
};

/// The production queries on one component, and two other ways to query Embree.
Result<std::vector<LeakKernel>> kernels_of(const Scene& scene) {
    auto production = Accel::build(scene, "");
    if (!production) return fail(production.error());
    auto robust = ReferenceKernels::build(scene, {});
    if (!robust) return fail(robust.error());
    auto fast = ReferenceKernels::build(scene, {.robust = false});
    if (!fast) return fail(fast.error());
    const auto accel = std::make_shared<Accel>(std::move(*production));
    return std::vector<LeakKernel>{
        {"obscura",
         true,
         [accel](const RayColumns& rays, const HitColumns& hits) {
             accel->intersect(rays, hits, Coherence::incoherent, {});
         }},
        {"robust 1",
         true,
         [kernel = *robust](const RayColumns& rays, const HitColumns& hits) {
             kernel.intersect(rays, hits, 1);
         }},
        {"fast 16", false, [kernel = *fast](const RayColumns& rays, const HitColumns& hits) {
             kernel.intersect(rays, hits, 16);
         }}};
}

Result<void> shoot_component(const Scene& scene,
                             const TrueScene& component,
                             const std::vector<Vec3d>& points,
                             const std::array<uint64_t, 2>& rays_and_seed,
                             LeakReport& report) {
    auto kernels = kernels_of(scene);
    if (!kernels) return fail(kernels.error());
    if (report.kernels.empty()) {
        for (const LeakKernel& kernel : *kernels)
            report.kernels.push_back({kernel.name, kernel.in_budget, {}, {}});
    }
    const bool mesh = is_mesh(scene.primitives.front());
    for (size_t k = 0; k < kernels->size(); ++k) {
        for (size_t aim = 0; aim < (mesh ? leak_aims : 1); ++aim) {
            // Fast traversal only shows what robust scenes prevent.
            const uint64_t share = aim == 0 && (*kernels)[k].in_budget ? 1 : 10;
            const Room room{component,
                            points,
                            (rays_and_seed[0] + share - 1) / share,
                            static_cast<LeakAim>(aim),
                            rays_and_seed[1]};
            shoot(room, (*kernels)[k].ask, report.kernels[k]);
        }
    }
    return {};
}

}  // namespace

std::vector<Vec3d> points_inside(const TrueScene& component, size_t most, uint64_t seed) {
    std::vector<Vec3d> points;
    const TrueBox box = component.bounds();
    const Vec3d half = (box.high - box.low) * 0.5;
    const Vec3d centre = box.low + half;
    for (uint64_t tries = 0; tries < 8 * most && points.size() < most; ++tries) {
        RandomStream random(tries ^ (seed << 40));
        const Vec3d target =
            centre +
            half * Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const Vec3d origin = centre + random.direction() * (2 * length(half));
        const TrueRay ray{origin, normalize(target - origin)};
        const std::vector<double> hits = sorted_hits(component, ray);
        if (hits.empty() || hits.size() % 2 != 0) continue;
        const size_t k = 2 * random.below(hits.size() / 2);
        const double middle = 0.5 * (hits[k] + hits[k + 1]);
        const double room = component.rounding_m(ray, component.item(0), middle) * clearance_ulps;
        if (hits[k + 1] - hits[k] < 2 * room) continue;
        RayBlock rounded;  // rays start at single precision positions
        rounded.add(origin + ray.direction * middle, random.direction());
        if (sorted_hits(component, rounded.true_ray(0)).size() % 2 == 1) {
            points.push_back(rounded.true_ray(0).origin);
        }
    }
    return points;
}

Result<LeakReport> count_leaks(const ClosedComponents& closed, uint64_t rays, uint64_t seed) {
    LeakReport report;
    report.components_found = closed.found;
    std::vector<size_t> used;
    std::vector<std::unique_ptr<TrueScene>> truths;
    std::vector<std::vector<Vec3d>> points;
    for (size_t i = 0; i < closed.components.size(); ++i) {
        auto truth = std::make_unique<TrueScene>(closed.components[i].scene);
        std::vector<Vec3d> inside = points_inside(*truth, points_wanted, seed + i);
        if (inside.empty()) continue;
        used.push_back(i);
        truths.push_back(std::move(truth));
        points.push_back(std::move(inside));
    }
    report.components_used = used.size();
    for (size_t u = 0; u < used.size(); ++u) {
        const uint64_t share = (rays + used.size() - 1) / used.size();
        const auto done = shoot_component(
            closed.components[used[u]].scene, *truths[u], points[u], {share, seed + u}, report);
        if (!done) return fail(done.error());
    }
    return report;
}

}  // namespace obscura::crosscheck
