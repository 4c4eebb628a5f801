// bench/report_json.cpp - the figures of a bench as JSON.
// SPDX-License-Identifier: Apache-2.0
#include "bench/report_json.h"

#include "base/json/json.h"
#include "bench/machine_json.h"

namespace obscura::bench {

namespace {

Json spread_json(const Spread& s) {
    return {{"median", s.median}, {"low", s.low}, {"high", s.high}};
}

Json point_json(const Vec3d& p) {
    return Json::array({p.x, p.y, p.z});
}

double ratio(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

double ratio(size_t part, size_t whole) {
    return ratio(static_cast<double>(part), static_cast<double>(whole));
}

void add_head(const BenchReport& report, Json& json) {
    const Machine& m = report.machine;
    json["version"] = m.version;
    json["circumstances"] = circumstances_of(report);
    json["machine"] = machine_json(m);
    const BenchSettings& s = report.settings;
    json["settings"] = {{"width", s.width},
                        {"height", s.height},
                        {"spp", s.samples_per_pixel},
                        {"depth", s.max_bounces},
                        {"seed", s.seed},
                        {"integrator", s.integrator},
                        {"environment", s.environment},
                        {"repeat", s.repeat}};
}

Json load_json(const LoadFigures& l) {
    return {{"load_s", spread_json(l.load_s)},
            {"parse_s", spread_json(l.parse_s)},
            {"decode_s", spread_json(l.decode_s)},
            {"prepare_s", spread_json(l.prepare_s)},
            {"bvh_s", spread_json(l.bvh_s)},
            {"triangles_per_second", ratio(static_cast<double>(l.triangles), l.bvh_s.median)},
            {"bare_read_s", spread_json(l.read_s)},
            {"bare_bvh_s", spread_json(l.bare_bvh_s)},
            {"of_bare", spread_json(l.of_bare)}};
}

Json memory_json(const MemoryFigures& m, size_t triangles) {
    return {{"bvh", m.bvh},
            {"geometry", m.geometry},
            {"textures", m.textures},
            {"film", m.film},
            {"scene", m.scene()},
            {"peak", m.peak},
            {"bytes_per_triangle",
             {{"bvh", ratio(m.bvh, triangles)},
              {"geometry", ratio(m.geometry, triangles)},
              {"scene", ratio(m.scene(), triangles)}}},
            {"bare_bvh", m.bare_bvh},
            {"bare_vertices", m.bare_vertices},
            {"bare_texels", m.bare_texels},
            {"bare", m.bare()},
            {"scene_over_bare", ratio(m.scene(), m.bare())}};
}

Json stages_json(const ViewFigures& view) {
    const auto fractions = stage_fractions(view);
    Json out = Json::object();
    for (size_t i = 0; i < fractions.size(); ++i) {
        out[stage_names()[i]] = {{"share", fractions[i]},
                                 {"thread_s", spread_json(view.stage_s[i])}};
    }
    return out;
}

Json kinds_json(const ViewFigures& view) {
    Json out = Json::object();
    for (size_t k = 0; k < ray_kinds; ++k) {
        const KindFigures& kind = view.kinds[k];
        const auto count = static_cast<double>(kind.rays);
        out[ray_kind_names[k]] = {{"count", kind.rays},
                                  {"hits", kind.hits},
                                  {"rays_per_second", ratio(count, kind.render_s)},
                                  {"bare_hits", kind.bare_hits},
                                  {"bare_way", replay_mode_name(kind.mode)},
                                  {"bare_rays_per_second", ratio(count, kind.bare_s.median)},
                                  {"bare_s", spread_json(kind.bare_s)},
                                  {"of_bare", ratio(kind.bare_s.median, kind.render_s)}};
    }
    return out;
}

/// Adds the members of one measured view.
void add_view(const ViewFigures& view, Json& json) {
    json["name"] = view.name;
    json["description"] = view.description;
    json["camera"] = {{"eye", point_json(view.camera.eye_m)},
                      {"target", point_json(view.camera.target_m)},
                      {"up", point_json(view.camera.up)},
                      {"fov_deg", view.camera.yfov_deg}};
    json["coverage"] = view.coverage;
    json["isa"] = view.isa;
    json["threads"] = view.threads;
    json["render_s"] = spread_json(view.render_s);
    json["replay_s"] = spread_json(view.replay_s);
    json["of_bare"] = spread_json(view.of_bare);
    const RenderCounters& c = view.counters;
    const uint64_t rays = c.camera_rays + c.bounce_rays + c.shadow_rays;
    json["paths"] = c.paths;
    json["paths_per_second"] = per_second(view, c.paths);
    json["samples_per_second"] = per_second(view, c.paths);
    json["rays_per_second"] = per_second(view, rays);
    json["refused_rays"] = c.refused_rays;
    json["nonfinite_samples"] = c.nonfinite_samples;
    json["stages"] = stages_json(view);
    json["outside_stages"] = outside_stages(view);
    json["rays"] = kinds_json(view);
}

void add_scaling(const SceneFigures& scene, Json& json) {
    Json& by_threads = json["by_threads"] = Json::array();
    for (const ViewFigures& row : scene.by_threads) {
        const ViewFigures& base = fewest_threads(scene, row);
        Json& out = by_threads.emplace_back();
        out["speedup"] = speedup_over(base, row);
        out["efficiency"] = parallel_efficiency(base, row);
        add_view(row, out);
    }
    Json& by_isa = json["by_isa"] = Json::array();
    for (const ViewFigures& row : scene.by_isa) {
        Json& out = by_isa.emplace_back();
        if (const ViewFigures* base = baseline_row(scene, row); base != nullptr) {
            out["speedup"] = speedup_over(*base, row);
            out["shading_speedup"] = shading_speedup(*base, row);
        }
        add_view(row, out);
    }
}

Json scene_json(const SceneFigures& scene) {
    Json out;
    out["name"] = scene.name;
    out["file"] = scene.file;
    out["file_bytes"] = scene.load.file_bytes;
    out["triangles"] = scene.load.triangles;
    out["triangles_in_world"] = scene.load.triangles_in_world;
    out["load"] = load_json(scene.load);
    out["memory"] = memory_json(scene.memory, scene.load.triangles);
    Json& views = out["views"] = Json::array();
    for (const ViewFigures& view : scene.views)
        add_view(view, views.emplace_back());
    add_scaling(scene, out);
    return out;
}

}  // namespace

std::string bench_json(const BenchReport& report, const std::vector<Change>& changes) {
    Json json;
    add_head(report, json);
    Json& scenes = json["scenes"] = Json::array();
    for (const SceneFigures& scene : report.scenes)
        scenes.push_back(scene_json(scene));
    json["figures"] = figures_json(comparable_figures(report));
    json["changes"] = changes_json(changes);
    json["warnings"] = report.warnings;
    return json_document(json);
}

}  // namespace obscura::bench
