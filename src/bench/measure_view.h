// bench/measure_view.h - one view rendered and replayed on bare Embree, several times over.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "bench/report.h"
#include "render/render.h"

#include <atomic>
#include <functional>

namespace obscura {

/// What is to be measured.
struct ViewTask {
    const PreparedScene* scene = nullptr;
    Camera camera;
    RenderOptions options;
    int repeat = 5;
    int threads = 0;  ///< as limited by the caller
    /// Called once, behind the first rendering and before anything is recorded.
    std::function<void()> after_first = {};
};

/// Renders once to warm up and once to record the rays; then, `repeat` times, renders and asks bare
/// Embree for the same rays, each kind in every way that suits it. Name, camera and coverage of
/// the result are left to the caller.
///
/// Errors  75 E-STOPPED; 33 E-MEM
Result<ViewFigures> measure_view(const ViewTask& task, const std::atomic<bool>& stop);

/// What is wrong with a measurement, as sentences: hits that differ between render and replay, a
/// picture that recording has changed. Empty: nothing.
std::vector<std::string> doubts_about(const ViewFigures& view);

}  // namespace obscura
