// benchmarks/stage_benchmarks.cpp - registers every stage of the corridor for one instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"
#include "benchmarks/stage_columns.h"
#include <chrono>
#include <memory>

namespace obscura::bench {

namespace {

using Columns = std::shared_ptr<StageColumns>;

/// Registers stage(columns), which handles `rows` rows a call. Only the stage itself is timed;
/// the columns are put back before each call.
template <typename Stage>
void register_stage(const std::string& name, const Columns& columns, int rows, const Stage& stage) {
    const auto run = [columns, rows, stage](benchmark::State& state) {
        for (auto _ : state) {
            columns->restore();
            const auto start = std::chrono::steady_clock::now();
            stage(*columns);
            const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
            state.SetIterationTime(time.count());
        }
        state.SetItemsProcessed(state.iterations() * rows);
        state.counters["rows"] = rows;
    };
    benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime();
}

void register_rays(const std::string& isa, const std::string& kind, const Columns& columns) {
    const Coherence coherence = columns->bounce == 0 ? Coherence::coherent : Coherence::incoherent;
    const auto segment = static_cast<uint32_t>(columns->bounce);
    register_stage(
        "stage/2_intersect_" + kind + "/" + isa, columns, columns->rows(), [=](StageColumns& c) {
            c.scene.accel->intersect(
                c.rays(), c.work.hits, coherence, {segment == 0, false, 2U * segment});
        });
    register_stage(
        "stage/3_shade_" + kind + "/" + isa, columns, columns->rows(), [](StageColumns& c) {
            c.scene.stages->shade(c.view, c.batch, c.bounce, c.rows(), c.shade_rows());
        });
}

void register_light(const std::string& isa, const Columns& columns) {
    const int shadows = columns->shaded.shadow;
    register_stage("stage/4_shadow/" + isa, columns, shadows, [](StageColumns& c) {
        c.scene.accel->occluded(c.shadow_rays(), c.work.occluded.data(), Coherence::incoherent, 1);
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
    const int rows = camera_rays->rows();
    // The ones that overwrite what the others read have columns of their own.
    const auto own = std::make_shared<StageColumns>(scene, camera, 0);
    register_stage("stage/1_camera/" + name, own, rows, [rows](StageColumns& c) {
        c.scene.stages->camera(c.batch, rows, c.work.paths[0], c.work.samples);
    });
    register_rays(name, "camera", camera_rays);
    register_rays(name, "bounce", std::make_shared<StageColumns>(scene, camera, 1));
    const auto shadow_rays = std::make_shared<StageColumns>(scene, camera, 0);
    shadow_rays->make_shadow_rays();
    register_light(name, shadow_rays);
    const auto sums = std::make_shared<std::vector<float>>(4 * static_cast<size_t>(own->pixels));
    register_stage("stage/5_accumulate/" + name, own, rows, [sums](StageColumns& c) {
        c.scene.stages->accumulate(c.pixels, c.batch.samples, c.work.samples, sums->data());
    });
}

}  // namespace obscura::bench
