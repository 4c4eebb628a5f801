// bench/measure_standard.cpp - renders the scenes of the standard in rounds.
// SPDX-License-Identifier: Apache-2.0
#include "bench/measure_standard.h"

#include "bench/machine.h"

#include <fmt/format.h>
#include <utility>
#include <vector>

namespace obscura::bench {

namespace {

/// A scene that is ready to be rendered.
struct ReadyScene {
    PreparedScene prepared;
    Camera camera;
    NoiseOfRenderings noise = {};
};

RenderOptions options_of(const StandardTask& task, int seed) {
    RenderOptions out;
    out.width = task.width;
    out.height = task.height;
    out.samples_per_pixel = task.samples_per_pixel;
    out.max_bounces = standard_depth;
    out.seed = static_cast<uint64_t>(seed);
    return out;
}

size_t triangles_of(const Scene& scene) {
    const auto of_primitives = [&](int32_t first, int32_t count) {
        size_t sum = 0;
        for (int32_t i = first; i < first + count; ++i)
            sum += static_cast<size_t>(scene.primitives[static_cast<size_t>(i)].triangle_count);
        return sum;
    };
    size_t sum = of_primitives(0, scene.world_primitive_count);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        sum += of_primitives(mesh.first_primitive, mesh.primitive_count);
    }
    return sum;
}

Result<std::vector<ReadyScene>> prepare(const StandardTask& task,
                                        StandardReport& report,
                                        Log& log) {
    std::vector<ReadyScene> out;
    for (const StandardScene& scene : standard_scenes()) {
        log.info(fmt::format("making {}: {}", scene.name, scene.what));
        StandardFigures figures;
        figures.name = scene.name;
        figures.what = scene.what;
        figures.noise = scene.noise;
        figures.expected_mean = scene.mean;
        Result<PreparedScene> prepared =
            PreparedScene::create(scene.make(), scene.light(), task.isa, log);
        if (!prepared) return fail(prepared.error());
        figures.triangles = triangles_of(prepared->scene());
        report.scenes.push_back(std::move(figures));
        report.isa = prepared->isa_name();
        report.machine.embree = prepared->embree_version();
        out.push_back({std::move(*prepared), camera_of(scene, task.width, task.height)});
    }
    return out;
}

/// Renders a scene; its time counts unless it is to warm up.
Result<RenderResult> render_once(const StandardTask& task,
                                 const ReadyScene& scene,
                                 int seed,
                                 const std::atomic<bool>& stop) {
    return render(scene.prepared, scene.camera, options_of(task, seed), {}, stop);
}

Result<void> measure_round(const StandardTask& task,
                           int round,
                           std::vector<ReadyScene>& scenes,
                           StandardReport& report,
                           const std::atomic<bool>& stop) {
    for (size_t i = 0; i < scenes.size(); ++i) {
        const Result<RenderResult> result = render_once(task, scenes[i], round, stop);
        if (!result) return fail(result.error());
        report.scenes[i].seconds.push_back(result->render_seconds);
        if (round >= task.min_rounds) continue;
        scenes[i].noise.add(result->film.pixels, result->film.channels.size());
    }
    return {};
}

}  // namespace

Result<StandardReport> measure_standard(const StandardTask& task,
                                        const std::atomic<bool>& stop,
                                        Log& log) {
    StandardReport report;
    report.machine = describe_machine();
    report.threads = task.threads;
    report.width = task.width;
    report.height = task.height;
    report.samples_per_pixel = task.samples_per_pixel;
    report.max_bounces = standard_depth;
    Result<std::vector<ReadyScene>> scenes = prepare(task, report, log);
    if (!scenes) return fail(scenes.error());
    for (const ReadyScene& scene : *scenes) {
        if (auto warm = render_once(task, scene, 0, stop); !warm) return fail(warm.error());
    }
    for (int round = 0; round < task.max_rounds && !report.is_steady; ++round) {
        if (auto done = measure_round(task, round, *scenes, report, stop); !done) {
            return fail(done.error());
        }
        if (round + 1 < task.min_rounds) continue;
        for (size_t i = 0; i < scenes->size(); ++i) {
            report.scenes[i].relative_error = (*scenes)[i].noise.relative_error();
            report.scenes[i].mean = (*scenes)[i].noise.mean();
        }
        finish(report);
        log.info(fmt::format("round {}: score {:.3f}, uncertain by {:.1f} %",
                             round + 1,
                             report.score,
                             100 * report.spread));
    }
    for (const std::string& doubt : doubts_about(report))
        log.warn("standard", doubt);
    return report;
}

}  // namespace obscura::bench
