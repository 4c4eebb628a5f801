// bench/measure_load.cpp - loading and building a scene, against its bytes and bare Embree.
// SPDX-License-Identifier: Apache-2.0
#include "bench/measure_load.h"

#include "base/peak_memory.h"
#include "base/stopwatch.h"
#include "bench/asset_files.h"
#include "gltf/asset_files.h"
#include "scene/scene_memory.h"

#include <algorithm>
#include <optional>

namespace obscura::bench {

namespace {

constexpr double max_seconds = 20;

/// The measured times, one value a repetition.
struct Repetitions {
    std::vector<double> load, parse, decode, prepare, bvh, read, bare_bvh, of_bare;
};

Result<PreparedScene> load_once(const LoadTask& task, Log& log, Repetitions& series) {
    const Stopwatch loading;
    Result<Scene> scene = gltf::load_gltf(task.file, task.load, log);
    if (!scene) return fail(scene.error());
    series.load.push_back(loading.seconds());
    series.parse.push_back(scene->info.parse_seconds);
    series.decode.push_back(scene->info.decode_seconds);
    auto prepared = PreparedScene::create(std::move(*scene), task.lighting, task.isa, log);
    if (!prepared) return prepared;
    series.prepare.push_back(prepared->build_seconds().all);
    series.bvh.push_back(prepared->build_seconds().bvh);
    return prepared;
}

/// Reads the bytes and builds bare Embree; returns the memory of that build.
Result<size_t> bare_once(const PreparedScene& prepared,
                         const std::vector<std::filesystem::path>& files,
                         Isa isa,
                         Repetitions& series) {
    const Stopwatch reading;
    read_all(files);
    series.read.push_back(reading.seconds());
    const Result<BareBuild> bare = Accel::build_bare(prepared.scene(), embree_isa_for(isa));
    if (!bare) return fail(bare.error());
    series.bare_bvh.push_back(bare->seconds);
    const double ours = series.load.back() + series.prepare.back();
    series.of_bare.push_back((series.read.back() + bare->seconds) / std::max(ours, 1e-12));
    return bare->bytes;
}

LoadFigures figures_of(const Repetitions& series) {
    LoadFigures out;
    out.load_s = spread_of(series.load);
    out.parse_s = spread_of(series.parse);
    out.decode_s = spread_of(series.decode);
    out.prepare_s = spread_of(series.prepare);
    out.bvh_s = spread_of(series.bvh);
    out.read_s = spread_of(series.read);
    out.bare_bvh_s = spread_of(series.bare_bvh);
    out.of_bare = spread_of(series.of_bare);
    return out;
}

MemoryFigures memory_of(const PreparedScene& prepared, size_t bare_bvh) {
    const Scene& scene = prepared.scene();
    MemoryFigures out;
    out.bvh = prepared.bvh_bytes();
    out.geometry = geometry_bytes(scene);
    out.textures = texture_bytes(scene);
    out.bare_bvh = bare_bvh;
    out.bare_vertices = vertex_bytes(scene);
    out.bare_texels = base_texel_bytes(scene);
    return out;
}

}  // namespace

Result<LoadedScene> measure_load(const LoadTask& task, Log& log) {
    const std::vector<std::filesystem::path> files = gltf::files_of_asset(task.file);
    const Stopwatch all;
    Log silent(Verbosity::quiet);
    Repetitions series;
    std::optional<PreparedScene> kept;
    size_t bare_bytes = 0;
    size_t peak = 0;
    for (int i = 0; i < task.repeat && (i == 0 || all.seconds() < max_seconds); ++i) {
        kept.reset();  // two at a time would double the peak of memory
        reset_peak_memory();
        Result<PreparedScene> prepared = load_once(task, i == 0 ? log : silent, series);
        if (!prepared) return fail(prepared.error());
        peak = peak_memory_bytes();
        const Result<size_t> bare = bare_once(*prepared, files, task.isa, series);
        if (!bare) return fail(bare.error());
        bare_bytes = *bare;
        kept = std::move(*prepared);
    }
    LoadFigures figures = figures_of(series);
    figures.file_bytes = read_all(files);
    figures.triangles = stored_triangles(kept->scene());
    figures.triangles_in_world = kept->scene().info.triangles_in_world;
    MemoryFigures memory = memory_of(*kept, bare_bytes);
    memory.peak = peak;
    return LoadedScene{std::move(*kept), figures, memory};
}

}  // namespace obscura::bench
