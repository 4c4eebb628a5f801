// crosscheck/report_table.cpp - the results of a cross-check as tables for people.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/report_table.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace obscura::crosscheck {

namespace {

constexpr std::array<const char*, verdict_count> verdict_names{
    "agree", "eq.depth", "edge", "crack", "edge-on", "place", "item", "depth", "missed", "false"};

void add_row(const std::string& got,
             const std::string& expected,
             const Tally& tally,
             std::string& out) {
    out += fmt::format("  {:<20} {:<18} {:>10} {:>10}", got, expected, tally.rays, tally.hits);
    for (const uint64_t count : tally.counts)
        out += fmt::format(" {:>9}", count);
    out += fmt::format(" {:>7.2g}\n", tally.widest_edge);
}

void add_head(const char* first, const char* second, std::string& out) {
    out += fmt::format("  {:<20} {:<18} {:>10} {:>10}", first, second, "rays", "hits");
    for (const char* name : verdict_names)
        out += fmt::format(" {:>9}", name);
    out += "     ulp\n";
}

void add_worst(const PairFigures& pair, std::string& out) {
    for (const Difference& d : pair.worst) {
        if (d.comparison.verdict < Verdict::place) continue;
        out += fmt::format("    {} ray {} ({}): {}, expected {}; {}\n      {}\n",
                           pair.got,
                           d.number,
                           ray_group_names[static_cast<size_t>(d.group)],
                           describe(d.got),
                           describe(d.expected),
                           describe(d.comparison),
                           replay_option(d.ray));
    }
}

void add_twins(const TwinReport& twins, std::string& out) {
    if (twins.shapes + twins.skipped == 0) return;
    out += fmt::format("  shapes beside fine meshes: {} of {}, {} triangles; ulp: of the mesh\n",
                       twins.shapes,
                       twins.shapes + twins.skipped,
                       twins.triangles);
    if (!twins.figures) return;
    add_row(twins.figures->got, twins.figures->expected, twins.figures->total(), out);
    add_worst(*twins.figures, out);
}

void add_leaks(const LeakReport& leaks, std::string& out) {
    out += fmt::format("  closed parts: {} found, {} with room inside\n",
                       leaks.components_found,
                       leaks.components_used);
    for (const LeakFigures& kernel : leaks.kernels) {
        out += fmt::format("    {:<12}", kernel.kernel);
        for (size_t aim = 0; aim < leak_aims; ++aim) {
            const LeakCount& count = kernel.by_aim[aim];
            out +=
                fmt::format("  {}: {} leaks of {}", leak_aim_names[aim], count.leaks, count.rays);
        }
        out += '\n';
        if (kernel.first) out += "      " + replay_option(*kernel.first) + '\n';
    }
}

void add_spawned(const SpawnedReport& spawned, std::string& out) {
    out += fmt::format(
        "  spawned rays: {} self-hits of {}; at edges, along surfaces and from afar {} of "
        "{}\n  walls 1e-4 of the size away: {} passed of {}\n",
        spawned.self_hits,
        spawned.rays,
        spawned.aimed_self_hits,
        spawned.aimed_rays,
        spawned.wall_leaks,
        spawned.wall_rays);
    if (spawned.first_self_hit) {
        out += "    self-hit: " + replay_option(*spawned.first_self_hit) + '\n';
    }
    if (spawned.first_wall_leak) {
        out += "    passed the wall: " + replay_option(*spawned.first_wall_leak) + '\n';
    }
}

}  // namespace

const char* verdict_name(Verdict verdict) {
    return verdict_names[static_cast<size_t>(verdict)];
}

std::string describe(const Answer& answer) {
    if (!answer.found()) return "miss";
    if (answer.any) return "occluded";
    return fmt::format("t={:.9g} instance={} primitive={} row={}",
                       answer.t,
                       answer.item.instance,
                       answer.item.primitive,
                       answer.item.element);
}

std::string describe(const Comparison& comparison) {
    const char* name = verdict_name(comparison.verdict);
    if (comparison.verdict <= Verdict::equal_depth) return name;
    if (std::isinf(comparison.ulps)) return fmt::format("{}, no ray nearby explains it", name);
    return fmt::format("{}, {:.3g} ulp", name, comparison.ulps);
}

std::string replay_option(const TrueRay& ray) {
    const std::string option = fmt::format("--ray {:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}",
                                           ray.origin.x,
                                           ray.origin.y,
                                           ray.origin.z,
                                           ray.direction.x,
                                           ray.direction.y,
                                           ray.direction.z);
    return std::isinf(ray.end) ? option : option + fmt::format(",{:.9g}", ray.end);
}

std::string check_table(const CheckedScene& scene) {
    std::string out = fmt::format(
        "\n{}: {} triangles, {} shapes, {} in the world; {} rays; {} of them searched through "
        "everything, {} wrong\n",
        scene.name,
        scene.counts.triangles,
        scene.counts.shapes,
        scene.items_in_world,
        scene.rays,
        scene.truth.rays,
        scene.truth.wrong);
    out += fmt::format("  formulas in double: {} of {} segments wrong; the truth: {}\n",
                       scene.formulas.wrong,
                       scene.formulas.segments,
                       scene.formulas.wrong_truth);
    add_head("kernel", "against", out);
    for (const PairFigures& pair : scene.pairs)
        add_row(pair.got, pair.expected, pair.total(), out);
    for (const PairFigures& pair : scene.pairs) {
        if (pair.got != "obscura" || !pair.against_truth) continue;
        add_head("obscura, by rays", "", out);
        for (size_t g = 0; g < ray_groups; ++g)
            add_row(ray_group_names[g], pair.expected, pair.groups[g], out);
    }
    for (const PairFigures& pair : scene.pairs) {
        if (pair.standard != Standard::none) add_worst(pair, out);
    }
    add_twins(scene.twins, out);
    add_leaks(scene.leaks, out);
    add_spawned(scene.spawned, out);
    if (scene.viewer) {
        const ViewerReport& v = *scene.viewer;
        out += fmt::format(
            "  Embree's viewer: {}; {} pixels, differing in occlusion {}, geomID {}, "
            "primID {}, Ng {}; ties {}\n",
            v.state,
            v.pixels,
            v.occlusion,
            v.geometry,
            v.primitive,
            v.normal,
            v.ties);
    }
    out += scene.faults.empty() ? "  within the budget\n" : "  OUTSIDE THE BUDGET\n";
    for (const std::string& fault : scene.faults)
        out += "    " + fault + '\n';
    return out;
}

}  // namespace obscura::crosscheck
