// bench/report_table.cpp - the figures of a bench as tables for people.
// SPDX-License-Identifier: Apache-2.0
#include "bench/report.h"

#include <algorithm>
#include <fmt/format.h>

namespace obscura::bench {

namespace {

double mebibytes(size_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

double ratio(size_t a, size_t b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0;
}

/// Seconds with the width of their range: "0.421 s +-3%".
std::string seconds(const Spread& s) {
    return fmt::format("{:.4g} s (spread {:.1f} %)", s.median, 100 * s.relative());
}

void add_head(const BenchReport& report, std::string& out) {
    const Machine& m = report.machine;
    const BenchSettings& s = report.settings;
    out += fmt::format("Obscura {}, {}, {}, Embree {}\n{}, {} cores\n",
                       m.version,
                       m.compiler,
                       m.build_type,
                       m.embree,
                       m.cpu,
                       m.cores);
    out += fmt::format("{}x{}, {} spp, depth {}, integrator {}, median of {}\n",
                       s.width,
                       s.height,
                       s.samples_per_pixel,
                       s.max_bounces,
                       s.integrator,
                       s.repeat);
}

void add_load(const SceneFigures& scene, std::string& out) {
    const LoadFigures& l = scene.load;
    const MemoryFigures& m = scene.memory;
    const double bvh_rate =
        l.bvh_s.median > 0 ? static_cast<double>(l.triangles) / l.bvh_s.median * 1e-6 : 0;
    out += fmt::format("\n{}: {} triangles, {} in the world, {:.1f} MiB in files\n",
                       scene.name,
                       l.triangles,
                       l.triangles_in_world,
                       mebibytes(l.file_bytes));
    out += fmt::format(
        "  load         {}, of which images {:.4g} s\n", seconds(l.load_s), l.decode_s.median);
    out += fmt::format("  BVH          {}, {:.2f} M triangles/s; lights and tables {:.4g} s\n",
                       seconds(l.bvh_s),
                       bvh_rate,
                       std::max(l.prepare_s.median - l.bvh_s.median, 0.0));
    out += fmt::format("  load + build {:.1f} % of bare: bytes {:.4g} s + Embree {:.4g} s\n",
                       100 * l.of_bare.median,
                       l.read_s.median,
                       l.bare_bvh_s.median);
    out += fmt::format(
        "  memory       BVH {:.2f}, geometry {:.2f}, textures {:.2f}, film {:.2f}, peak {:.1f} "
        "MiB\n",
        mebibytes(m.bvh),
        mebibytes(m.geometry),
        mebibytes(m.textures),
        mebibytes(m.film),
        mebibytes(m.peak));
    out += fmt::format(
        "               {:.1f} bytes a triangle in the BVH, {:.1f} in geometry; scene "
        "{:.2f} times bare\n",
        ratio(m.bvh, l.triangles),
        ratio(m.geometry, l.triangles),
        ratio(m.scene(), m.bare()));
}

void add_kinds(const ViewFigures& view, std::string& out) {
    out += "    rays             M rays   M/s in its stage     M/s bare   of bare  bare way\n";
    for (size_t k = 0; k < ray_kinds; ++k) {
        const KindFigures& kind = view.kinds[k];
        if (kind.rays == 0) continue;
        const double millions = static_cast<double>(kind.rays) * 1e-6;
        const auto rate = [&](double s) { return s > 0 ? millions / s : 0; };
        out += fmt::format("    {:<12} {:>10.3f} {:>18.2f} {:>12.2f} {:>7.1f} %  {}\n",
                           ray_kind_names[k],
                           millions,
                           rate(kind.render_s),
                           rate(kind.bare_s.median),
                           kind.render_s > 0 ? 100 * kind.bare_s.median / kind.render_s : 0,
                           replay_mode_name(kind.mode));
    }
}

void add_view(const ViewFigures& view, std::string& out) {
    const RenderCounters& c = view.counters;
    const uint64_t rays = c.camera_rays + c.bounce_rays + c.shadow_rays;
    out += fmt::format("  view {}: {}; covers {:.1f} % of the frame; {}, {} threads\n",
                       view.name,
                       view.description,
                       100 * view.coverage,
                       view.isa,
                       view.threads);
    out += fmt::format("    of bare Embree   {:.1f} % ({:.1f} to {:.1f}): replay {}\n",
                       100 * view.of_bare.median,
                       100 * view.of_bare.low,
                       100 * view.of_bare.high,
                       seconds(view.replay_s));
    out += fmt::format("    render           {}, {:.3f} M paths/s (samples/s), {:.3f} M rays/s\n",
                       seconds(view.render_s),
                       per_second(view, c.paths) * 1e-6,
                       per_second(view, rays) * 1e-6);
    out += "    stages          ";
    const auto fractions = stage_fractions(view);
    for (size_t i = 0; i < fractions.size(); ++i)
        out += fmt::format(" {} {:.1f} %", stage_names()[i], 100 * fractions[i]);
    out += fmt::format("; outside {:.1f} %\n", 100 * outside_stages(view));
    add_kinds(view, out);
}

void add_scaling(const SceneFigures& scene, std::string& out) {
    if (scene.by_threads.empty()) return;
    out += "  scaling: view    threads      render   M paths/s   speed-up  efficiency   of bare\n";
    for (const ViewFigures& row : scene.by_threads) {
        const double speedup = speedup_over(fewest_threads(scene, row), row);
        out += fmt::format(
            "           {:<8} {:>5} {:>9.4f} s {:>11.3f} {:>10.2f} {:>9.1f} % {:>7.1f} %\n",
            row.name,
            row.threads,
            row.render_s.median,
            per_second(row, row.counters.paths) * 1e-6,
            speedup,
            100 * parallel_efficiency(fewest_threads(scene, row), row),
            100 * row.of_bare.median);
    }
}

void add_isas(const SceneFigures& scene, std::string& out) {
    if (scene.by_isa.empty()) return;
    out +=
        "  ISA:     view    set           render   M paths/s  speed-up  shading only   of bare\n";
    for (const ViewFigures& row : scene.by_isa) {
        const ViewFigures* base = baseline_row(scene, row);
        out += fmt::format(
            "           {:<8} {:<9} {:>8.4f} s {:>11.3f} {:>9.2f} {:>13.2f} {:>7.1f} %\n",
            row.name,
            row.isa,
            row.render_s.median,
            per_second(row, row.counters.paths) * 1e-6,
            base != nullptr ? speedup_over(*base, row) : 0,
            base != nullptr ? shading_speedup(*base, row) : 0,
            100 * row.of_bare.median);
    }
}

}  // namespace

std::string bench_table(const BenchReport& report) {
    std::string out;
    add_head(report, out);
    for (const SceneFigures& scene : report.scenes) {
        add_load(scene, out);
        for (const ViewFigures& view : scene.views)
            add_view(view, out);
        add_scaling(scene, out);
        add_isas(scene, out);
    }
    return out;
}

}  // namespace obscura::bench
