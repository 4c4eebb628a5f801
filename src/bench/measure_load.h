// bench/measure_load.h - loading and building a scene, against its bytes and bare Embree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "bench/report.h"
#include "gltf/load.h"
#include "render/render.h"

#include <filesystem>

namespace obscura::bench {

struct LoadTask {
    std::filesystem::path file;
    gltf::LoadOptions load;
    LightingOptions lighting;
    Isa isa = Isa::automatic;
    int repeat = 5;
};

struct LoadedScene {
    PreparedScene scene;  ///< of the last repetition
    LoadFigures figures;
    MemoryFigures memory;  ///< without film; peak is that of loading
};

/// Loads and prepares up to `repeat` times, each time beside reading the bytes and the bare build;
/// stops repeating after 20 seconds.
///
/// Errors  those of load_gltf and PreparedScene::create
Result<LoadedScene> measure_load(const LoadTask& task, Log& log);

}  // namespace obscura::bench
