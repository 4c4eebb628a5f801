// bench/standard_report.cpp - the score of the standard as a table and as JSON to publish.
// SPDX-License-Identifier: Apache-2.0
#include "bench/standard_report.h"

#include "base/json/json.h"
#include "bench/machine_json.h"
#include "bench/standard_scenes.h"

#include <fmt/format.h>

namespace obscura::bench {

namespace {

constexpr double million = 1e-6;

/// Samples a second of each round.
Spread speeds_of(const StandardReport& report, const StandardFigures& scene) {
    const double samples = static_cast<double>(report.width) * report.height *
                           static_cast<double>(report.samples_per_pixel);
    std::vector<double> speeds;
    for (const double seconds : scene.seconds)
        speeds.push_back(samples / seconds);
    return spread_of(std::move(speeds));
}

Json scene_json(const StandardReport& report, const StandardFigures& scene) {
    const Spread speeds = speeds_of(report, scene);
    return {{"name", scene.name},
            {"triangles", scene.triangles},
            {"samples_per_second",
             {{"median", speeds.median}, {"low", speeds.low}, {"high", speeds.high}}},
            {"relative_error", scene.relative_error},
            {"noise", scene.noise},
            {"samples_for_noise", report.samples_per_pixel * scene.relative_error / scene.noise},
            {"samples_per_second_at_noise", scene.at_fixed_noise(speeds.median)},
            {"mean", scene.mean},
            {"expected_mean", scene.expected_mean}};
}

}  // namespace

std::string standard_table(const StandardReport& report) {
    std::string out = fmt::format("Obscura standard {}, Obscura {}, {}, {} threads, {}\n\n",
                                  standard_version,
                                  report.machine.version,
                                  report.isa,
                                  report.threads,
                                  report.machine.cpu);
    out += fmt::format(
        "{:<12} {:>12} {:>12} {:>14}\n", "scene", "Msamples/s", "rel. error", "at fixed noise");
    for (const StandardFigures& scene : report.scenes) {
        out += fmt::format("{:<12} {:>12.3f} {:>12.5f} {:>14.3f}\n",
                           scene.name,
                           million * scene.samples_per_second,
                           scene.relative_error,
                           million * scene.at_fixed_noise(scene.samples_per_second));
    }
    out += fmt::format("\nscore {:.3f}, uncertain by {:.1f} % after {} rounds{}\n",
                       report.score,
                       100 * report.spread,
                       report.rounds.size(),
                       report.is_steady ? "" : ": not steady, not to be published");
    return out;
}

std::string circumstances_of(const StandardReport& report) {
    const Machine& m = report.machine;
    return fmt::format("standard {}, {}, {} cores, {} threads, {}, Embree {}, {} {}",
                       standard_version,
                       m.cpu,
                       m.cores,
                       report.threads,
                       report.isa,
                       m.embree,
                       m.compiler,
                       m.build_type);
}

std::vector<Figure> comparable_figures(const StandardReport& report) {
    const std::string prefix = fmt::format("standard {}/", standard_version);
    std::vector<Figure> out = {{prefix + "score_per_s", spread_of(report.rounds)}};
    for (const StandardFigures& scene : report.scenes)
        out.push_back({prefix + scene.name + "/samples_per_s", speeds_of(report, scene)});
    return out;
}

std::string standard_json(const StandardReport& report, const std::vector<Change>& changes) {
    Json json;
    json["standard"] = standard_version;
    json["score"] = report.score;
    json["spread"] = report.spread;
    json["steady"] = report.is_steady;
    json["rounds"] = report.rounds;
    json["version"] = report.machine.version;
    json["isa"] = report.isa;
    json["threads"] = report.threads;
    json["circumstances"] = circumstances_of(report);
    json["machine"] = machine_json(report.machine);
    json["settings"] = {{"width", report.width},
                        {"height", report.height},
                        {"spp", report.samples_per_pixel},
                        {"depth", report.max_bounces}};
    Json& scenes = json["scenes"] = Json::array();
    for (const StandardFigures& scene : report.scenes)
        scenes.push_back(scene_json(report, scene));
    json["figures"] = figures_json(comparable_figures(report));
    json["changes"] = changes_json(changes);
    json["warnings"] = report.warnings;
    return json_document(json);
}

}  // namespace obscura::bench
