// crosscheck/check_scene.cpp - runs all checks of one scene.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/check_scene.h"

#include "base/parallel.h"
#include "crosscheck/budget.h"
#include "crosscheck/report_table.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>

namespace obscura::crosscheck {

namespace {

constexpr size_t max_components = 32;
/// Limit on the triangles and shapes of the search without boxes.
constexpr uint64_t max_exhaustive_items = 400000000;

TruthCheck check_truth(const TrueScene& truth, const RaySet& rays) {
    const uint64_t items = std::max<uint64_t>(truth.item_count(), 1);
    const uint64_t wanted = std::clamp<uint64_t>(max_exhaustive_items / items, 16, 4096);
    const auto chunks = static_cast<size_t>(std::min<uint64_t>(wanted, rays.chunks()));
    std::atomic<uint64_t> wrong = 0;
    std::atomic<uint64_t> checked = 0;
    parallel_for(chunks, [&](size_t chunk) {
        RayBlock block;
        rays.fill(chunk, block);
        const uint64_t each = std::max<uint64_t>(wanted / chunks, 1);
        for (int i = 0; i < block.count() && static_cast<uint64_t>(i) < each; ++i) {
            const TrueRay ray = block.true_ray(i);
            const bool same = truth.nearest(ray).t == truth.nearest_of_all(ray).t;
            wrong.fetch_add(same ? 0 : 1, std::memory_order_relaxed);
            checked.fetch_add(1, std::memory_order_relaxed);
        }
    });
    return {checked.load(), wrong.load()};
}

/// State of comparing one batch: the references of every kernel.
struct Comparing {
    const TrueScene& truth;
    const RayBatch& batch;
    CheckedScene& out;
    const CheckTask& task;
    Log& log;
    AnswerList truths = {};
    AnswerList base = {};  ///< of the first kernel
    size_t compared = 0;   ///< pairs so far; equal in every batch

    void run(const Kernel& planned, Standard standard) {
        const Kernel kernel = task.stand_in ? task.stand_in(planned) : planned;
        std::vector<AnswerList*> references = {&truths};
        const bool first = base.answers.empty();
        if (!first) references.push_back(&base);
        std::vector<PairFigures> pairs =
            compare_kernel(truth,
                           batch,
                           kernel,
                           references,
                           {.answers = first ? &base : nullptr,
                            .screen = standard == Standard::full ? &out.screen : nullptr});
        for (PairFigures& pair : pairs) {
            pair.standard = standard;
            if (compared < out.pairs.size()) {
                out.pairs[compared].add(pair);
            } else {
                out.pairs.push_back(std::move(pair));
            }
            ++compared;
        }
        log.detail(out.name + ": " + kernel.name + " done");
    }
};

Result<void> compare_references(Comparing& comparing, const Scene& scene) {
    for (const KernelGroup& group : plan_kernels(scene)) {
        auto built = ReferenceKernels::build(scene, group.choice);
        if (!built) return fail(built.error());
        const auto shared = std::make_shared<const ReferenceKernels>(std::move(*built));
        for (const PlannedKernel& planned : group.kernels)
            comparing.run(make_kernel(shared, planned), group.standard);
    }
    return {};
}

Result<void> compare_production(Comparing& comparing, const Scene& scene, Isa isa) {
    auto accel = Accel::build(scene, embree_isa_for(isa));
    if (!accel) return fail(accel.error());
    const auto shared = std::make_shared<const Accel>(std::move(*accel));
    for (const Kernel& kernel : production_kernels(shared))
        comparing.run(kernel, Standard::full);
    return {};
}

Result<void> compare_all(Comparing& comparing, const Scene& scene, Isa isa) {
    const TrueScene& truth = comparing.truth;
    compare_kernel(truth, comparing.batch, truth_kernel(truth), {}, {.answers = &comparing.truths});
    comparing.truths.is_truth = true;
    comparing.log.detail(comparing.out.name + ": searched in double precision");
    if (auto done = compare_references(comparing, scene); !done) return done;
    return compare_production(comparing, scene, isa);
}

}  // namespace

Result<CheckedScene> check_scene(const CheckTask& task, Log& log) {
    const Scene scene = opaque_copy(*task.scene);
    const TrueScene truth(scene);
    const RaySet rays(truth, task.rays);
    CheckedScene out;
    out.name = task.name;
    out.file = task.file;
    out.counts = count_shapes(scene);
    out.items_in_world = truth.item_count();
    out.rays = rays.count();
    const size_t pixels =
        static_cast<size_t>(task.rays.width) * static_cast<size_t>(task.rays.height);
    out.screen = {task.rays.width, task.rays.height, {}, {}};
    out.screen.worst.assign(pixels, -1);
    out.screen.hit.assign(pixels, 0);
    out.formulas = check_formulas(truth, rays.count(), task.rays.seed);
    out.truth = check_truth(truth, rays);
    for (const RayBatch& batch : batches_of(rays)) {
        Comparing comparing{truth, batch, out, task, log};
        if (auto done = compare_all(comparing, scene, task.isa); !done) return fail(done.error());
    }
    auto twins = check_twins(scene, rays.count(), embree_isa_for(task.isa));
    if (!twins) return fail(twins.error());
    out.twins = std::move(*twins);
    log.detail(out.name + ": shapes compared with meshes");
    const ClosedComponents closed = find_closed_components(scene, max_components);
    auto leaks = count_leaks(closed, 10 * rays.count(), task.rays.seed);
    if (!leaks) return fail(leaks.error());
    out.leaks = std::move(*leaks);
    log.detail(out.name + ": leaks counted");
    Log silent(Verbosity::quiet);
    const auto prepared = PreparedScene::create(scene, {}, task.isa, silent);
    if (!prepared) return fail(prepared.error());
    auto spawned = check_spawned(*prepared, truth, rays, task.isa);
    if (!spawned) return fail(spawned.error());
    out.spawned = *spawned;
    if (task.export_embree) {
        auto viewer = export_for_embree(
            scene, task.rays.camera, {task.rays.width, task.rays.height}, *task.export_embree);
        if (!viewer) return fail(viewer.error());
        out.viewer = std::move(*viewer);
    }
    out.faults = faults_of(out);
    return out;
}

Result<std::string> replay_ray(const Scene& scene, const TrueRay& ray, Isa isa) {
    const Scene opaque = opaque_copy(scene);
    const TrueScene truth(opaque);
    RayBlock block;
    block.add(ray.origin, ray.direction);
    if (std::isfinite(ray.end)) block.set_end(0, ray.end);
    const Answer expected = answer_of(truth.nearest_of_all(block.true_ray(0)));
    std::string text;
    const auto add = [&](const Kernel& kernel) {
        std::vector<Answer> answers;
        kernel.ask(block, answers);
        const Comparison found = compare(truth, block.true_ray(0), expected, answers[0]);
        text +=
            fmt::format("{:<22} {:<52} {}\n", kernel.name, describe(answers[0]), describe(found));
    };
    add(truth_kernel(truth));
    auto accel = Accel::build(opaque, embree_isa_for(isa));
    if (!accel) return fail(accel.error());
    for (const Kernel& kernel :
         production_kernels(std::make_shared<const Accel>(std::move(*accel))))
        add(kernel);
    for (const KernelGroup& group : plan_kernels(opaque)) {
        auto built = ReferenceKernels::build(opaque, group.choice);
        if (!built) return fail(built.error());
        const auto shared = std::make_shared<const ReferenceKernels>(std::move(*built));
        for (const PlannedKernel& planned : group.kernels)
            add(make_kernel(shared, planned));
    }
    return text;
}

}  // namespace obscura::crosscheck
