// crosscheck/report_json.cpp - the results of a cross-check as JSON.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/report_json.h"

#include "base/json/json.h"
#include "crosscheck/budget.h"
#include "crosscheck/report_table.h"

namespace obscura::crosscheck {

namespace {

constexpr std::array<const char*, verdict_count> verdict_keys{"agree",
                                                              "equal_depth",
                                                              "edge",
                                                              "crack",
                                                              "edge_on",
                                                              "place",
                                                              "item",
                                                              "depth",
                                                              "missed",
                                                              "false_hit"};

constexpr std::array<const char*, 3> standard_names{"full", "edges", "none"};

void add_tally(const Tally& tally, Json& out) {
    out["rays"] = tally.rays;
    out["hits"] = tally.hits;
    for (size_t v = 0; v < verdict_count; ++v)
        out[verdict_keys[v]] = tally.counts[v];
    out["widest_edge_ulp"] = tally.widest_edge;
}

Json answer_json(const Answer& answer) {
    Json out;
    out["found"] = answer.found();
    if (answer.item.primitive >= 0) {
        out["t"] = answer.t;
        out["instance"] = answer.item.instance;
        out["primitive"] = answer.item.primitive;
        out["row"] = answer.item.element;
    }
    return out;
}

Json pair_json(const PairFigures& pair) {
    Json out;
    out["kernel"] = pair.got;
    out["against"] = pair.expected;
    out["held_to"] = standard_names[static_cast<size_t>(pair.standard)];
    add_tally(pair.total(), out);
    Json& by_rays = out["by_rays"] = Json::object();
    for (size_t g = 0; g < ray_groups; ++g)
        add_tally(pair.groups[g], by_rays[ray_group_names[g]]);
    Json& worst = out["worst"] = Json::array();
    for (const Difference& d : pair.worst) {
        worst.push_back({{"rays", ray_group_names[static_cast<size_t>(d.group)]},
                         {"number", d.number},
                         {"verdict", verdict_keys[static_cast<size_t>(d.comparison.verdict)]},
                         {"ulp", d.comparison.ulps},
                         {"replay", replay_option(d.ray)},
                         {"expected", answer_json(d.expected)},
                         {"got", answer_json(d.got)}});
    }
    return out;
}

Json twins_json(const TwinReport& twins) {
    Json out = {
        {"shapes", twins.shapes}, {"skipped", twins.skipped}, {"triangles", twins.triangles}};
    Json& pairs = out["pairs"] = Json::array();
    if (twins.figures) pairs.push_back(pair_json(*twins.figures));
    return out;
}

Json leaks_json(const LeakReport& leaks) {
    Json out = {{"closed_parts", leaks.components_found}, {"parts_used", leaks.components_used}};
    Json& kernels = out["kernels"] = Json::array();
    for (const LeakFigures& kernel : leaks.kernels) {
        Json& entry = kernels.emplace_back();
        entry["kernel"] = kernel.kernel;
        entry["in_budget"] = kernel.in_budget;
        for (size_t aim = 0; aim < leak_aims; ++aim) {
            entry[leak_aim_names[aim]] = {{"rays", kernel.by_aim[aim].rays},
                                          {"leaks", kernel.by_aim[aim].leaks}};
        }
        if (kernel.first) entry["first"] = replay_option(*kernel.first);
    }
    return out;
}

Json spawned_json(const SpawnedReport& spawned) {
    return {{"rays", spawned.rays},
            {"self_hits", spawned.self_hits},
            {"aimed_rays", spawned.aimed_rays},
            {"aimed_self_hits", spawned.aimed_self_hits},
            {"wall_rays", spawned.wall_rays},
            {"wall_passed", spawned.wall_leaks}};
}

Json viewer_json(const ViewerReport& viewer) {
    return {{"state", viewer.state},
            {"pixels", viewer.pixels},
            {"occlusion", viewer.occlusion},
            {"geometry", viewer.geometry},
            {"primitive", viewer.primitive},
            {"normal", viewer.normal},
            {"ties", viewer.ties}};
}

Json scene_json(const CheckedScene& scene) {
    Json out;
    out["name"] = scene.name;
    out["file"] = scene.file;
    out["triangles"] = scene.counts.triangles;
    out["shapes"] = scene.counts.shapes;
    out["in_world"] = scene.items_in_world;
    out["rays"] = scene.rays;
    out["truth"] = {{"searched_through_everything", scene.truth.rays},
                    {"wrong", scene.truth.wrong}};
    out["formulas"] = {{"segments", scene.formulas.segments},
                       {"wrong", scene.formulas.wrong},
                       {"wrong_truth", scene.formulas.wrong_truth}};
    Json& pairs = out["pairs"] = Json::array();
    for (const PairFigures& pair : scene.pairs)
        pairs.push_back(pair_json(pair));
    out["twins"] = twins_json(scene.twins);
    out["leaks"] = leaks_json(scene.leaks);
    out["spawned"] = spawned_json(scene.spawned);
    if (scene.viewer) out["embree_viewer"] = viewer_json(*scene.viewer);
    out["faults"] = scene.faults;
    out["within_budget"] = scene.faults.empty();
    return out;
}

}  // namespace

std::string crosscheck_json(const std::vector<CheckedScene>& scenes,
                            const std::vector<std::string>& warnings) {
    Json out;
    out["version"] = OBSCURA_VERSION;
    out["budget"] = {
        {"mismatch_share", mismatch_fraction}, {"edge_ulp", edge_ulps}, {"depth_ulp", depth_ulps}};
    Json& entries = out["scenes"] = Json::array();
    for (const CheckedScene& scene : scenes)
        entries.push_back(scene_json(scene));
    out["warnings"] = warnings;
    return json_document(out);
}

}  // namespace obscura::crosscheck
