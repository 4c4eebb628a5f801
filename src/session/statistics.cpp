// session/statistics.cpp - the --stats file: times, memory, counters and warnings.
// SPDX-License-Identifier: Apache-2.0
#include "session/statistics.h"

#include "base/json/json.h"
#include "base/peak_memory.h"
#include "render/integrators.h"

#include <algorithm>

namespace obscura {

namespace {

double per_second(uint64_t count, double seconds) {
    return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

Json phases_json(const RenderStatistics& statistics) {
    return {{"load_s", statistics.load_s},
            {"parse_s", statistics.parse_s},
            {"decode_s", statistics.decode_s},
            {"build_s", statistics.build_s},
            {"render_s", statistics.render_s},
            {"write_s", statistics.write_s},
            {"total_s", statistics.total_s}};
}

void add_rays(const RenderStatistics& statistics, Json& json) {
    const RenderCounters& counters = statistics.counters;
    json["rays"] = {{"camera", counters.camera_rays},
                    {"bounce", counters.bounce_rays},
                    {"shadow", counters.shadow_rays},
                    {"total", total_rays(counters)}};
    json["paths"] = counters.paths;
    Json& stages = json["stages"] = Json::object();
    for (const NamedSeconds& stage : by_stage(counters.stages))
        stages[std::string(stage.name) + "_s"] = stage.seconds;
    json["rays_per_second"] = per_second(total_rays(counters), statistics.render_s);
    json["paths_per_second"] = per_second(counters.paths, statistics.render_s);
}

void add_memory(const RenderStatistics& statistics, Json& json) {
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["memory"] = {{"bvh", statistics.bvh_bytes},
                      {"geometry", statistics.geometry_bytes},
                      {"textures", statistics.texture_bytes},
                      {"film", statistics.film_bytes}};
}

Json samples_json(const AdaptiveOptions& asked, const SamplesTaken& taken) {
    return {{"noise_target", asked.noise_target},
            {"noise", taken.noise ? Json(*taken.noise) : Json()},
            {"passes", taken.passes},
            {"total", taken.total},
            {"min", taken.least},
            {"max", taken.most},
            {"mean", taken.mean()}};
}

Json degraded_json(const gltf::Degraded& degraded) {
    return {{"textures", degraded.textures},
            {"primitives", degraded.primitives},
            {"triangles", degraded.triangles}};
}

Json frames_json(const RenderStatistics& statistics) {
    Json out = Json::array();
    for (const FrameStatistics& frame : statistics.frames) {
        out.push_back({{"frame", frame.number},
                       {"time_s", frame.time_s},
                       {"load_s", frame.load_s},
                       {"build_s", frame.build_s},
                       {"render_s", frame.render_s},
                       {"write_s", frame.write_s}});
    }
    return out;
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

void add_samples(const SamplesTaken& from, std::optional<SamplesTaken>& to) {
    if (!to) {
        to = from;
        return;
    }
    to->passes = std::max(from.passes, to->passes);
    to->total += from.total;
    to->pixels += from.pixels;
    to->least = std::min(from.least, to->least);
    to->most = std::max(from.most, to->most);
    to->noise = std::max(from.noise, to->noise);
}

void add_degraded(const gltf::Degraded& from, gltf::Degraded& to) {
    to.textures = std::max(from.textures, to.textures);
    to.primitives = std::max(from.primitives, to.primitives);
    to.triangles = std::max(from.triangles, to.triangles);
}

uint64_t total_rays(const RenderCounters& counters) {
    return counters.camera_rays + counters.bounce_rays + counters.shadow_rays;
}

std::string statistics_json(const RenderRequest& request, const RenderStatistics& statistics) {
    const RenderOptions& options = request.options;
    Json json;
    json["version"] = OBSCURA_VERSION;
    json["scene"] = request.scene.string();
    Json& outputs = json["outputs"] = Json::array();
    for (const std::filesystem::path& output : request.outputs)
        outputs.push_back(output.string());
    if (request.standard_output) outputs.push_back("-");
    json["width"] = options.width;
    json["height"] = options.height;
    json["spp"] = samples_taken(options);
    if (options.adaptive && statistics.adaptive)
        json["samples"] = samples_json(*options.adaptive, *statistics.adaptive);
    json["seed"] = options.seed;
    json["depth"] = options.max_bounces;
    json["integrator"] = entry_of(options.integrator).name;
    json["threads"] = statistics.threads;
    json["isa"] = statistics.isa;
    json["embree"] = statistics.embree;
    json["phases"] = phases_json(statistics);
    add_rays(statistics, json);
    add_memory(statistics, json);
    json["counters"] = {{"refused_rays", statistics.counters.refused_rays},
                        {"nonfinite_samples", statistics.counters.nonfinite_samples}};
    json["lenient"] = request.load.lenient;
    json["degraded"] = degraded_json(statistics.degraded);
    if (request.frames) {
        json["fps"] = request.frames->fps;
        json["frames"] = frames_json(statistics);
    }
    json["warnings"] = statistics.warnings;
    return json_document(json);
}

bool too_many_nonfinite(const RenderCounters& counters) {
    return static_cast<double>(counters.nonfinite_samples) >
           1e-6 * static_cast<double>(counters.paths);
}

}  // namespace obscura
