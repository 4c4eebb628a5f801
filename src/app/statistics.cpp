// app/statistics.cpp - the --stats file: what a rendering took and what it met.
// SPDX-License-Identifier: Apache-2.0
#include "app/statistics.h"

#include "base/json_writer.h"
#include "base/peak_memory.h"
#include "render/integrators.h"

#include <algorithm>

namespace obscura {

namespace {

double per_second(uint64_t count, double seconds) {
    return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

void write_phases(const RenderStatistics& statistics, JsonWriter& json) {
    json.key("phases").begin_object();
    json.member("load_s", statistics.load_s);
    json.member("parse_s", statistics.parse_s);
    json.member("decode_s", statistics.decode_s);
    json.member("build_s", statistics.build_s);
    json.member("render_s", statistics.render_s);
    json.member("write_s", statistics.write_s);
    json.member("total_s", statistics.total_s);
    json.end_object();
}

void write_rays(const RenderStatistics& statistics, JsonWriter& json) {
    const RenderCounters& counters = statistics.counters;
    json.key("rays").begin_object();
    json.member("camera", counters.camera_rays);
    json.member("bounce", counters.bounce_rays);
    json.member("shadow", counters.shadow_rays);
    json.member("total", total_rays(counters));
    json.end_object();
    json.member("paths", counters.paths);
    json.key("stages").begin_object();
    for (const NamedSeconds& stage : by_stage(counters.stages))
        json.member(std::string(stage.name) + "_s", stage.seconds);
    json.end_object();
    json.member("rays_per_second", per_second(total_rays(counters), statistics.render_s));
    json.member("paths_per_second", per_second(counters.paths, statistics.render_s));
}

void write_memory(const RenderStatistics& statistics, JsonWriter& json) {
    json.member("peak_memory_bytes", peak_memory_bytes());
    json.key("memory").begin_object();
    json.member("bvh", statistics.bvh_bytes);
    json.member("geometry", statistics.geometry_bytes);
    json.member("textures", statistics.texture_bytes);
    json.member("film", statistics.film_bytes);
    json.end_object();
}

void write_degraded(const RenderRequest& request, const Degraded& degraded, JsonWriter& json) {
    json.member("lenient", request.load.lenient);
    json.key("degraded").begin_object();
    json.member("textures", degraded.textures);
    json.member("primitives", degraded.primitives);
    json.member("triangles", degraded.triangles);
    json.end_object();
}

void write_frames(const RenderRequest& request,
                  const RenderStatistics& statistics,
                  JsonWriter& json) {
    if (!request.frames) return;
    json.member("fps", request.frames->fps);
    json.key("frames").begin_array();
    for (const FrameStatistics& frame : statistics.frames) {
        json.begin_object();
        json.member("frame", frame.number);
        json.member("time_s", frame.time_s);
        json.member("load_s", frame.load_s);
        json.member("build_s", frame.build_s);
        json.member("render_s", frame.render_s);
        json.member("write_s", frame.write_s);
        json.end_object();
    }
    json.end_array();
}

}  // namespace

void add_counters(const RenderCounters& from, RenderCounters& to) {
    to.paths += from.paths;
    to.camera_rays += from.camera_rays;
    to.bounce_rays += from.bounce_rays;
    to.shadow_rays += from.shadow_rays;
    to.refused_rays += from.refused_rays;
    to.nonfinite_samples += from.nonfinite_samples;
    to.stages.add(from.stages);
}

void add_degraded(const Degraded& from, Degraded& to) {
    to.textures = std::max(from.textures, to.textures);
    to.primitives = std::max(from.primitives, to.primitives);
    to.triangles = std::max(from.triangles, to.triangles);
}

uint64_t total_rays(const RenderCounters& counters) {
    return counters.camera_rays + counters.bounce_rays + counters.shadow_rays;
}

std::string statistics_json(const RenderRequest& request, const RenderStatistics& statistics) {
    const RenderOptions& options = request.options;
    JsonWriter json;
    json.begin_object();
    json.member("version", OBSCURA_VERSION);
    json.member("scene", request.scene.string());
    json.key("outputs").begin_array();
    for (const std::filesystem::path& output : request.outputs)
        json.value(output.string());
    json.end_array();
    json.member("width", options.width);
    json.member("height", options.height);
    json.member("spp", samples_taken(options));
    json.member("seed", options.seed);
    json.member("depth", options.max_bounces);
    json.member("integrator", row_of(options.integrator).name);
    json.member("threads", statistics.threads);
    json.member("isa", statistics.isa);
    json.member("embree", statistics.embree);
    write_phases(statistics, json);
    write_rays(statistics, json);
    write_memory(statistics, json);
    json.key("counters").begin_object();
    json.member("refused_rays", statistics.counters.refused_rays);
    json.member("nonfinite_samples", statistics.counters.nonfinite_samples);
    json.end_object();
    write_degraded(request, statistics.degraded, json);
    write_frames(request, statistics, json);
    json.key("warnings").begin_array();
    for (const std::string& warning : statistics.warnings)
        json.value(warning);
    json.end_array();
    json.end_object();
    return std::move(json).take();
}

bool too_many_nonfinite(const RenderCounters& counters) {
    return static_cast<double>(counters.nonfinite_samples) >
           1e-6 * static_cast<double>(counters.paths);
}

}  // namespace obscura
