// crosscheck/check_scene.h - the results of all checks of one scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "crosscheck/embree_export.h"
#include "crosscheck/formula_check.h"
#include "crosscheck/kernel_plan.h"
#include "crosscheck/leaks.h"
#include "crosscheck/spawned.h"
#include "crosscheck/twins.h"
#include "stages/dispatch.h"

#include <string>
#include <vector>

namespace obscura::crosscheck {

/// The truth's hierarchy, compared with an exhaustive search.
struct TruthCheck {
    uint64_t rays = 0;
    uint64_t wrong = 0;
};

struct CheckedScene {
    std::string name;
    std::string file;
    ShapeCounts counts;
    size_t items_in_world = 0;
    uint64_t rays = 0;
    TruthCheck truth;
    FormulaCheck formulas;
    std::vector<PairFigures> pairs;
    TwinReport twins;
    LeakReport leaks;
    SpawnedReport spawned;
    std::optional<ViewerReport> viewer;  ///< if it was asked for
    ScreenVerdicts screen;
    std::vector<std::string> faults;  ///< figures outside the budget; empty: none
};

struct CheckTask {
    const Scene* scene = nullptr;  ///< as loaded
    std::string name;
    std::string file;
    RaySetOptions rays;
    Isa isa = Isa::automatic;                                 ///< of the renderer's own queries
    std::optional<std::filesystem::path> export_embree = {};  ///< folder for Embree's viewer
    /// Replaces kernels, so that tests can spoil answers. Empty: the kernels themselves.
    std::function<Kernel(const Kernel&)> stand_in = {};
};

/// Runs all checks of one scene. Memory: answers to one batch of rays (200 MB at most), and two
/// hierarchies at a time; they are built again for every batch.
///
/// Errors  those of Accel::build and PreparedScene::create
Result<CheckedScene> check_scene(const CheckTask& task, Log& log);

/// One ray through every kernel, as lines of text.
///
/// Errors  those of Accel::build
Result<std::string> replay_ray(const Scene& scene, const TrueRay& ray, Isa isa);

}  // namespace obscura::crosscheck
