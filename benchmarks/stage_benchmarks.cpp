// benchmarks/stage_benchmarks.cpp - registers every stage of the wavefront pipeline for one ISA.
// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"
#include "benchmarks/stage_columns.h"
#include <ctime>
#include <memory>

namespace obscura::benchmarks {

namespace {

using Columns = std::shared_ptr<StageColumns>;

/// Registers stage(columns), which handles `count` entries a call and does not change its input.
template <typename Stage>
void register_stage(const std::string& name,
                    const Columns& columns,
                    int count,
                    const Stage& stage) {
    const auto run = [columns, count, stage](benchmark::State& state) {
        columns->restore();  // another benchmark may have shaded them
        for (auto _ : state) {
            stage(*columns);
            benchmark::ClobberMemory();
        }
        state.SetItemsProcessed(state.iterations() * count);
        state.counters["rows"] = count;
    };
    benchmark::RegisterBenchmark(name.c_str(), run);
}

/// This thread's own time: on a busy machine the wall clock counts what others do.
double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Shading packs its input in place: before each call the columns are restored, untimed.
void register_shade(const std::string& name, const Columns& columns) {
    const auto run = [columns](benchmark::State& state) {
        StageColumns& c = *columns;
        for (auto _ : state) {
            c.restore();
            const double start = thread_seconds();
            c.scene.stages->shade(c.view, c.batch, c.bounce, c.count(), c.shade_columns());
            state.SetIterationTime(thread_seconds() - start);
        }
        state.SetItemsProcessed(state.iterations() * c.count());
        state.counters["rows"] = c.count();
    };
    benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime();
}

void register_rays(const std::string& isa, const std::string& kind, const Columns& columns) {
    const Coherence coherence = columns->bounce == 0 ? Coherence::coherent : Coherence::incoherent;
    const auto segment = static_cast<uint32_t>(columns->bounce);
    register_stage(
        "stage/2_intersect_" + kind + "/" + isa, columns, columns->count(), [=](StageColumns& c) {
            c.scene.accel->intersect(
                c.rays(), c.work.hits, coherence, {segment == 0, false, 2U * segment});
        });
    register_shade("stage/3_shade_" + kind + "/" + isa, columns);
}

void register_light(const std::string& isa, const Columns& columns) {
    const int shadows = columns->shaded.shadow;
    register_stage("stage/4_shadow/" + isa, columns, shadows, [](StageColumns& c) {
        c.scene.accel->occluded(
            c.shadow_rays(), c.work.occluded.data(), Coherence::incoherent, {1});
    });
    register_stage("stage/5_add_shadows/" + isa, columns, shadows, [](StageColumns& c) {
        c.scene.stages->add_shadows(
            c.shaded.shadow, c.work.shadows, c.work.occluded.data(), c.work.samples);
    });
}

}  // namespace

void register_stages(const PreparedScene& scene, const Camera& camera, Isa isa) {
    const std::string name = isa_name(isa);
    const auto camera_rays = std::make_shared<StageColumns>(scene, camera, 0);
    const int count = camera_rays->count();
    // Stages that overwrite what others read have columns of their own.
    const auto own = std::make_shared<StageColumns>(scene, camera, 0);
    register_stage("stage/1_camera/" + name, own, count, [count](StageColumns& c) {
        c.scene.stages->camera(c.batch, count, c.work.paths[0], c.work.samples, nullptr);
    });
    register_rays(name, "camera", camera_rays);
    register_rays(name, "bounce", std::make_shared<StageColumns>(scene, camera, 1));
    const auto shadow_rays = std::make_shared<StageColumns>(scene, camera, 0);
    shadow_rays->make_shadow_rays();
    register_light(name, shadow_rays);
    const auto sums = std::make_shared<std::vector<PixelSum>>(own->pixels);
    register_stage("stage/5_accumulate/" + name, own, count, [sums](StageColumns& c) {
        c.scene.stages->accumulate(c.pixels, {0, c.batch.samples}, c.work.samples, sums->data());
    });
}

}  // namespace obscura::benchmarks
