// bench/measure_view.h - renders one view and replays its rays on bare Embree, repeatedly.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "bench/report.h"
#include "render/render.h"

#include <atomic>
#include <functional>

namespace obscura::bench {

/// What is to be measured.
struct ViewTask {
    const PreparedScene* scene = nullptr;
    Camera camera;
    RenderOptions options;
    int repeat = 5;
    int threads = 0;  ///< as limited by the caller
    /// Called once, after the first rendering and before anything is recorded.
    std::function<void()> after_first = {};
};

/// Renders once to warm up and once to record the rays; then, `repeat` times, renders and traces
/// the same rays on bare Embree, each kind in every mode that suits it. The caller fills in name,
/// camera and coverage.
///
/// Errors  75 E-STOPPED; 33 E-MEM
Result<ViewFigures> measure_view(const ViewTask& task, const std::atomic<bool>& stop);

/// Faults of a measurement, as sentences: less than 50 ms a rendering, hits that differ between
/// rendering and replay, an image that recording has changed. Empty: none.
std::vector<std::string> doubts_about(const ViewFigures& view);

}  // namespace obscura::bench
