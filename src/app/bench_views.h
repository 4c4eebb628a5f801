// app/bench_views.h - chooses the cameras that the bench measures with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"
#include "bench/report.h"

#include <string>
#include <vector>

namespace obscura::app {

enum class ViewChoice { whole, close, both };

/// A camera to measure with, and how much of its frame the asset covers.
struct BenchView {
    std::string name;
    std::string description;
    Camera camera;
    bench::ViewCamera numbers;
    double coverage = 0;
};

/// Least fraction of a close view's frame that the asset covers.
inline constexpr double close_coverage = 0.7;

/// Fraction of a small rendering's pixels with a hit.
Result<double> measure_coverage(const PreparedScene& scene, const Camera& camera, double aspect);

/// The views of one scene: "whole" is the view of `obscura render`, always through a pinhole;
/// "close" its widest part that the asset covers by close_coverage, at most half as high where the
/// whole view covers that already. A camera placed by hand is the only view: "own".
///
/// Errors  those of choose_camera and render
Result<std::vector<BenchView>> choose_bench_views(const PreparedScene& scene,
                                                  const RenderRequest& request,
                                                  ViewChoice choice,
                                                  Log& log);

}  // namespace obscura::app
