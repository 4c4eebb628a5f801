// bench/report.cpp - figures derived from those of a bench.
// SPDX-License-Identifier: Apache-2.0
#include "bench/report.h"

#include <algorithm>

namespace obscura::bench {

std::array<const char*, 5> stage_names() {
    std::array<const char*, 5> names = {};
    const auto stages = by_stage({});
    for (size_t i = 0; i < names.size(); ++i)
        names[i] = stages[i].name;
    return names;
}

const char* replay_mode_name(ReplayMode mode) {
    switch (mode) {
        case ReplayMode::single:
            return "single";
        case ReplayMode::packets:
            return "packets of 16";
        case ReplayMode::coherent_packets:
            return "coherent packets of 16";
        case ReplayMode::coherent_streams:
            return "coherent streams of 32";
    }
    return "unknown";
}

std::array<double, 5> stage_fractions(const ViewFigures& view) {
    double sum = 0;
    for (const Spread& stage : view.stage_s)
        sum += stage.median;
    std::array<double, 5> fractions = {};
    for (size_t i = 0; sum > 0 && i < fractions.size(); ++i)
        fractions[i] = view.stage_s[i].median / sum;
    return fractions;
}

double outside_stages(const ViewFigures& view) {
    const double all = view.render_s.median * view.threads;
    double inside = 0;
    for (const Spread& stage : view.stage_s)
        inside += stage.median;
    return all > 0 ? std::max(0.0, 1 - inside / all) : 0;
}

double per_second(const ViewFigures& view, uint64_t count) {
    return view.render_s.median > 0 ? static_cast<double>(count) / view.render_s.median : 0;
}

double speedup_over(const ViewFigures& base, const ViewFigures& row) {
    return row.render_s.median > 0 ? base.render_s.median / row.render_s.median : 0;
}

double parallel_efficiency(const ViewFigures& base, const ViewFigures& row) {
    const double threads = static_cast<double>(row.threads) / std::max(base.threads, 1);
    return threads > 0 ? speedup_over(base, row) / threads : 0;
}

double shading_speedup(const ViewFigures& base, const ViewFigures& row) {
    constexpr size_t shade = 2;  // in the order of by_stage()
    const double seconds = row.stage_s[shade].median;
    return seconds > 0 ? base.stage_s[shade].median / seconds : 0;
}

const ViewFigures& fewest_threads(const SceneFigures& scene, const ViewFigures& row) {
    const ViewFigures* least = &row;
    for (const ViewFigures& other : scene.by_threads) {
        if (other.name == row.name && other.threads < least->threads) least = &other;
    }
    return *least;
}

const ViewFigures* baseline_row(const SceneFigures& scene, const ViewFigures& row) {
    for (const ViewFigures& other : scene.by_isa) {
        if (other.name == row.name && other.isa == "baseline") return &other;
    }
    return nullptr;
}

}  // namespace obscura::bench
