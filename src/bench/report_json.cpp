// bench/report_json.cpp - the figures of a bench for programs.
// SPDX-License-Identifier: Apache-2.0
#include "bench/report_json.h"

#include "base/json_writer.h"

namespace obscura {

namespace {

void write_spread(JsonWriter& json, std::string_view name, const Spread& s) {
    json.key(name).begin_object();
    json.member("median", s.median).member("low", s.low).member("high", s.high);
    json.end_object();
}

void write_point(JsonWriter& json, std::string_view name, const Vec3d& p) {
    json.key(name).begin_array().value(p.x).value(p.y).value(p.z).end_array();
}

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

double share(size_t part, size_t whole) {
    return share(static_cast<double>(part), static_cast<double>(whole));
}

void write_head(JsonWriter& json, const BenchReport& report) {
    const Machine& m = report.machine;
    json.member("version", m.version).member("circumstances", circumstances_of(report));
    json.key("machine").begin_object();
    json.member("cpu", m.cpu).member("cores", m.cores).member("embree", m.embree);
    json.member("compiler", m.compiler).member("build_type", m.build_type);
    json.end_object();
    const BenchSettings& s = report.settings;
    json.key("settings").begin_object();
    json.member("width", s.width).member("height", s.height).member("spp", s.samples_per_pixel);
    json.member("depth", s.max_bounces).member("seed", s.seed).member("integrator", s.integrator);
    json.member("environment", s.environment).member("repeat", s.repeat);
    json.end_object();
}

void write_load(JsonWriter& json, const LoadFigures& l) {
    json.member("file_bytes", l.file_bytes);
    json.member("triangles", l.triangles).member("triangles_in_world", l.triangles_in_world);
    json.key("load").begin_object();
    write_spread(json, "load_s", l.load_s);
    write_spread(json, "parse_s", l.parse_s);
    write_spread(json, "decode_s", l.decode_s);
    write_spread(json, "prepare_s", l.prepare_s);
    write_spread(json, "bvh_s", l.bvh_s);
    json.member("triangles_per_second", share(static_cast<double>(l.triangles), l.bvh_s.median));
    write_spread(json, "bare_read_s", l.read_s);
    write_spread(json, "bare_bvh_s", l.bare_bvh_s);
    write_spread(json, "of_bare", l.of_bare);
    json.end_object();
}

void write_memory(JsonWriter& json, const MemoryFigures& m, size_t triangles) {
    json.key("memory").begin_object();
    json.member("bvh", m.bvh).member("geometry", m.geometry).member("textures", m.textures);
    json.member("film", m.film).member("scene", m.scene()).member("peak", m.peak);
    json.key("bytes_per_triangle").begin_object();
    json.member("bvh", share(m.bvh, triangles)).member("geometry", share(m.geometry, triangles));
    json.member("scene", share(m.scene(), triangles)).end_object();
    json.member("bare_bvh", m.bare_bvh).member("bare_vertices", m.bare_vertices);
    json.member("bare_texels", m.bare_texels).member("bare", m.bare());
    json.member("scene_over_bare", share(m.scene(), m.bare()));
    json.end_object();
}

void write_stages(JsonWriter& json, const ViewFigures& view) {
    const auto shares = stage_shares(view);
    json.key("stages").begin_object();
    for (size_t i = 0; i < shares.size(); ++i) {
        json.key(stage_names()[i]).begin_object();
        json.member("share", shares[i]);
        write_spread(json, "thread_s", view.stage_s[i]);
        json.end_object();
    }
    json.end_object();
}

void write_kinds(JsonWriter& json, const ViewFigures& view) {
    json.key("rays").begin_object();
    for (size_t k = 0; k < ray_kinds; ++k) {
        const KindFigures& kind = view.kinds[k];
        const auto count = static_cast<double>(kind.rays);
        json.key(ray_kind_names[k]).begin_object();
        json.member("count", kind.rays).member("hits", kind.hits);
        json.member("rays_per_second", share(count, kind.render_s));
        json.member("bare_hits", kind.bare_hits).member("bare_way", way_name(kind.way));
        json.member("bare_rays_per_second", share(count, kind.bare_s.median));
        write_spread(json, "bare_s", kind.bare_s);
        json.member("of_bare", share(kind.bare_s.median, kind.render_s));
        json.end_object();
    }
    json.end_object();
}

/// The members of one measured view; the object is the caller's.
void write_view(JsonWriter& json, const ViewFigures& view) {
    json.member("name", view.name).member("description", view.description);
    json.key("camera").begin_object();
    write_point(json, "eye", view.camera.eye_m);
    write_point(json, "target", view.camera.target_m);
    write_point(json, "up", view.camera.up);
    json.member("fov_deg", view.camera.yfov_deg).end_object();
    json.member("coverage", view.coverage);
    json.member("isa", view.isa).member("threads", view.threads);
    write_spread(json, "render_s", view.render_s);
    write_spread(json, "replay_s", view.replay_s);
    write_spread(json, "of_bare", view.of_bare);
    const RenderCounters& c = view.counters;
    const uint64_t rays = c.camera_rays + c.bounce_rays + c.shadow_rays;
    json.member("paths", c.paths).member("paths_per_second", per_second(view, c.paths));
    json.member("samples_per_second", per_second(view, c.paths));
    json.member("rays_per_second", per_second(view, rays));
    json.member("refused_rays", c.refused_rays).member("nonfinite_samples", c.nonfinite_samples);
    write_stages(json, view);
    json.member("outside_stages", outside_stages(view));
    write_kinds(json, view);
}

void write_scaling(JsonWriter& json, const SceneFigures& scene) {
    json.key("by_threads").begin_array();
    for (const ViewFigures& row : scene.by_threads) {
        const ViewFigures& base = fewest_threads(scene, row);
        json.begin_object();
        json.member("speedup", speedup_over(base, row));
        json.member("efficiency", parallel_efficiency(base, row));
        write_view(json, row);
        json.end_object();
    }
    json.end_array();
    json.key("by_isa").begin_array();
    for (const ViewFigures& row : scene.by_isa) {
        json.begin_object();
        if (const ViewFigures* base = baseline_row(scene, row); base != nullptr) {
            json.member("speedup", speedup_over(*base, row));
            json.member("shading_speedup", shading_speedup(*base, row));
        }
        write_view(json, row);
        json.end_object();
    }
    json.end_array();
}

void write_scene(JsonWriter& json, const SceneFigures& scene) {
    json.begin_object();
    json.member("name", scene.name).member("file", scene.file);
    write_load(json, scene.load);
    write_memory(json, scene.memory, scene.load.triangles);
    json.key("views").begin_array();
    for (const ViewFigures& view : scene.views) {
        json.begin_object();
        write_view(json, view);
        json.end_object();
    }
    json.end_array();
    write_scaling(json, scene);
    json.end_object();
}

void write_figures(JsonWriter& json, const BenchReport& report) {
    json.key("figures").begin_array();
    for (const Figure& figure : comparable_figures(report)) {
        json.begin_object().member("name", figure.name);
        json.member("median", figure.value.median).member("low", figure.value.low);
        json.member("high", figure.value.high).end_object();
    }
    json.end_array();
}

}  // namespace

std::string bench_json(const BenchReport& report, const std::vector<Change>& changes) {
    JsonWriter json;
    json.begin_object();
    write_head(json, report);
    json.key("scenes").begin_array();
    for (const SceneFigures& scene : report.scenes)
        write_scene(json, scene);
    json.end_array();
    write_figures(json, report);
    json.key("changes").begin_array();
    for (const Change& change : changes) {
        json.begin_object().member("name", change.name).member("verdict", verdict(change));
        json.member("old_median", change.before.median).member("new_median", change.after.median);
        json.end_object();
    }
    json.end_array();
    json.key("warnings").begin_array();
    for (const std::string& warning : report.warnings)
        json.value(warning);
    json.end_array();
    json.end_object();
    return std::move(json).take();
}

}  // namespace obscura
