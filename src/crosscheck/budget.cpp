// crosscheck/budget.cpp - how many differences a cross-check accepts.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/budget.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace obscura::crosscheck {

namespace {

void check_pair(const PairFigures& pair, std::vector<std::string>& faults) {
    const uint64_t unexplained = pair.total().unexplained();
    if (unexplained > 0) {
        faults.push_back(
            fmt::format("{} against {}: {} of {} rays differ, and {:g} ulp do not "
                        "explain it",
                        pair.got,
                        pair.expected,
                        unexplained,
                        pair.total().rays,
                        edge_ulps));
    }
    const Tally unaimed = pair.unaimed();
    if (pair.standard == Standard::full && pair.against_truth &&
        unaimed.mismatches() > mismatches_allowed(unaimed.rays)) {
        faults.push_back(
            fmt::format("{} against {}: {} of {} rays aimed at nothing differ, more "
                        "than {:g} of them",
                        pair.got,
                        pair.expected,
                        unaimed.mismatches(),
                        unaimed.rays,
                        mismatch_fraction));
    }
}

void check_viewer(const ViewerReport& viewer, std::vector<std::string>& faults) {
    const double most = 1e-5 * static_cast<double>(viewer.pixels);
    const uint64_t numbers = std::max(viewer.primitive, viewer.normal);
    if (viewer.occlusion == 0 && viewer.geometry == 0 && static_cast<double>(numbers) <= most) {
        return;
    }
    faults.push_back(
        fmt::format("Embree's viewer: of {} pixels {} differ in occlusion, {} in "
                    "geomID, {} in primID, {} in Ng",
                    viewer.pixels,
                    viewer.occlusion,
                    viewer.geometry,
                    viewer.primitive,
                    viewer.normal));
}

}  // namespace

uint64_t mismatches_allowed(uint64_t rays) {
    // The Poisson distribution's upper tail: sums terms until less than a thousandth is left.
    const double mean = mismatch_fraction * static_cast<double>(rays);
    if (mean > 400) return static_cast<uint64_t>(mean + 3.1 * std::sqrt(mean));
    double term = std::exp(-mean);
    double below = term;
    uint64_t count = 0;
    while (1 - below > 1e-3) {
        ++count;
        term *= mean / static_cast<double>(count);
        below += term;
    }
    return count;
}

std::vector<std::string> faults_of(const CheckedScene& scene) {
    std::vector<std::string> faults;
    if (scene.truth.wrong > 0) {
        faults.push_back(
            fmt::format("the search in double precision missed {} of {} hits that a "
                        "search through everything has",
                        scene.truth.wrong,
                        scene.truth.rays));
    }
    if (scene.formulas.wrong > 0) {
        faults.push_back(
            fmt::format("the formulas in double precision are wrong about {} of {} "
                        "segments",
                        scene.formulas.wrong,
                        scene.formulas.segments));
    }
    if (scene.formulas.wrong_truth > 0) {
        faults.push_back(fmt::format("the truth is wrong about {} of {} segments",
                                     scene.formulas.wrong_truth,
                                     scene.formulas.segments));
    }
    for (const PairFigures& pair : scene.pairs) {
        if (pair.standard != Standard::none) check_pair(pair, faults);
    }
    if (scene.twins.figures) check_pair(*scene.twins.figures, faults);
    for (const LeakFigures& kernel : scene.leaks.kernels) {
        const LeakCount& random = kernel.by_aim[static_cast<size_t>(LeakAim::anywhere)];
        if (!kernel.in_budget || random.leaks == 0) continue;
        faults.push_back(fmt::format("{}: {} of {} rays leaked out of closed parts",
                                     kernel.kernel,
                                     random.leaks,
                                     random.rays));
    }
    if (scene.spawned.self_hits > 0) {
        faults.push_back(fmt::format("{} of {} spawned rays hit what they started on",
                                     scene.spawned.self_hits,
                                     scene.spawned.rays));
    }
    if (scene.spawned.wall_leaks > 0) {
        faults.push_back(fmt::format(
            "{} of {} rays passed a wall", scene.spawned.wall_leaks, scene.spawned.wall_rays));
    }
    if (scene.viewer) check_viewer(*scene.viewer, faults);
    return faults;
}

Result<void> check_budget(const std::vector<CheckedScene>& scenes) {
    for (const CheckedScene& scene : scenes) {
        if (scene.faults.empty()) continue;
        return fail(ExitCode::outside_budget, "E-CROSSCHECK", scene.file, scene.faults.front());
    }
    return {};
}

}  // namespace obscura::crosscheck
