// benchmarks/main.cpp - the micro-benchmark program: loads a scene, registers all, runs.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "gltf/load.h"
#include "image/decode.h"
#include "session/camera_choice.h"

#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"
#include <cstdio>
#include <deque>
#include <filesystem>

namespace obscura::benchmarks {

const char* isa_name(Isa isa) {
    return stage_table_for(isa).isa;
}

void register_missing_isa(const std::string& group, Isa isa) {
    const std::string name = group + "/skipped/" + isa_name(isa);
    benchmark::RegisterBenchmark(name.c_str(), [](benchmark::State& state) {
        state.SkipWithError("this CPU does not have that instruction set");
    });
}

namespace {

/// Everything that benchmarks read; lives until they have all run.
struct Inputs {
    Scene scene;
    LightingOptions lighting;
    std::optional<EnvironmentTable> environment;
    std::optional<KernelColumns> columns;
    Camera camera;
    std::deque<PreparedScene> prepared;  ///< one an instruction set: Embree is pinned to it
};

Result<void> load_inputs(const std::filesystem::path& scene_file,
                         const std::filesystem::path& environment_file,
                         Inputs& in) {
    Log log(Verbosity::quiet);
    auto scene = gltf::load_gltf(scene_file, {}, log);
    if (!scene) return fail(scene.error());
    in.scene = std::move(*scene);
    if (in.scene.textures.records.empty()) {
        return fail(ExitCode::usage, "E-BENCH-SCENE", scene_file.string(), "it has no textures");
    }
    auto image = read_environment(environment_file, log);
    if (!image) return fail(image.error());
    auto table =
        EnvironmentTable::create({image->width, image->height, image->pixels.data()}, 1, 0);
    if (!table) return fail(table.error());
    in.environment = std::move(*table);
    in.lighting.environment = std::make_shared<const ImageRgb32f>(std::move(*image));
    in.columns.emplace(in.scene, *in.environment);
    auto camera = choose_camera(in.scene, {}, 1280, 720, log);
    if (!camera) return fail(camera.error());
    in.camera = camera->camera;
    for (const Isa isa : all_isas) {
        if (!has_isa(isa)) continue;
        auto prepared = PreparedScene::create(in.scene, in.lighting, isa, log);
        if (!prepared) return fail(prepared.error());
        in.prepared.push_back(std::move(*prepared));
    }
    return {};
}

void register_all(const Inputs& in) {
    size_t next = 0;
    for (const Isa isa : all_isas) {
        if (has_isa(isa)) {
            register_stages(in.prepared[next++], in.camera, isa);
        } else {
            register_missing_isa("stage", isa);
        }
    }
    register_kernels(in.columns->data());
    register_particles();
}

int run(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    const std::filesystem::path assets = std::filesystem::path(OBSCURA_SOURCE_DIR) / "assets";
    const std::filesystem::path scene = argc > 1 ? argv[1] : assets / "showcase/showcase.gltf";
    const std::filesystem::path sky = argc > 2 ? argv[2] : assets / "environments/sky.hdr";
    if (argc > 3) {
        std::fprintf(stderr, "usage: obscura_micro [--benchmark_...] [SCENE [ENVIRONMENT]]\n");
        return static_cast<int>(ExitCode::usage);
    }
    Inputs inputs;
    if (const Result<void> loaded = load_inputs(scene, sky, inputs); !loaded) {
        const Error& error = loaded.error();
        std::fprintf(stderr, "ERROR %s: %s\n", error.where.c_str(), error.message.c_str());
        return static_cast<int>(error.code);
    }
    benchmark::AddCustomContext("obscura", OBSCURA_VERSION);
    benchmark::AddCustomContext("scene", scene.filename().string());
    const FlushDenormals as_in_the_renderer;
    register_all(inputs);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}  // namespace
}  // namespace obscura::benchmarks

int main(int argc, char** argv) {
    return obscura::benchmarks::run(argc, argv);
}
