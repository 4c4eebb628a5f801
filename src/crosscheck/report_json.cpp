// crosscheck/report_json.cpp - what a cross-check found, for programs.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/report_json.h"

#include "base/json_writer.h"
#include "crosscheck/budget.h"
#include "crosscheck/report_table.h"

namespace obscura {

namespace {

constexpr std::array<const char*, verdicts> verdict_keys{"agree",
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

void add_tally(JsonWriter& out, const Tally& tally) {
    out.member("rays", tally.rays).member("hits", tally.hits);
    for (size_t v = 0; v < verdicts; ++v)
        out.member(verdict_keys[v], tally.counts[v]);
    out.member("widest_edge_ulp", tally.widest_edge);
}

void add_answer(JsonWriter& out, const char* name, const Answer& answer) {
    out.key(name).begin_object();
    out.member("found", answer.found());
    if (answer.item.primitive >= 0) {
        out.member("t", answer.t)
            .member("instance", answer.item.instance)
            .member("primitive", answer.item.primitive)
            .member("row", answer.item.row);
    }
    out.end_object();
}

void add_pair(JsonWriter& out, const PairFigures& pair) {
    out.begin_object();
    out.member("kernel", pair.got)
        .member("against", pair.expected)
        .member("held_to", standard_names[static_cast<size_t>(pair.standard)]);
    add_tally(out, pair.total());
    out.key("by_rays").begin_object();
    for (size_t g = 0; g < ray_groups; ++g) {
        out.key(ray_group_names[g]).begin_object();
        add_tally(out, pair.groups[g]);
        out.end_object();
    }
    out.end_object();
    out.key("worst").begin_array();
    for (const Difference& d : pair.worst) {
        out.begin_object();
        out.member("rays", ray_group_names[static_cast<size_t>(d.group)])
            .member("number", d.number)
            .member("verdict", verdict_keys[static_cast<size_t>(d.comparison.verdict)])
            .member("ulp", d.comparison.ulps)
            .member("replay", replay_option(d.ray));
        add_answer(out, "expected", d.expected);
        add_answer(out, "got", d.got);
        out.end_object();
    }
    out.end_array();
    out.end_object();
}

void add_twins(JsonWriter& out, const TwinReport& twins) {
    out.key("twins").begin_object();
    out.member("shapes", twins.shapes)
        .member("skipped", twins.skipped)
        .member("triangles", twins.triangles);
    out.key("pairs").begin_array();
    if (twins.figures) add_pair(out, *twins.figures);
    out.end_array();
    out.end_object();
}

void add_leaks(JsonWriter& out, const LeakReport& leaks) {
    out.key("leaks").begin_object();
    out.member("closed_parts", leaks.parts_found).member("parts_used", leaks.parts_used);
    out.key("kernels").begin_array();
    for (const LeakFigures& kernel : leaks.kernels) {
        out.begin_object();
        out.member("kernel", kernel.kernel).member("in_budget", kernel.in_budget);
        for (size_t aim = 0; aim < leak_aims; ++aim) {
            out.key(leak_aim_names[aim]).begin_object();
            out.member("rays", kernel.by_aim[aim].rays).member("leaks", kernel.by_aim[aim].leaks);
            out.end_object();
        }
        if (kernel.first) out.member("first", replay_option(*kernel.first));
        out.end_object();
    }
    out.end_array();
    out.end_object();
}

void add_spawned(JsonWriter& out, const SpawnedReport& spawned) {
    out.key("spawned").begin_object();
    out.member("rays", spawned.rays)
        .member("self_hits", spawned.self_hits)
        .member("aimed_rays", spawned.aimed_rays)
        .member("aimed_self_hits", spawned.aimed_self_hits)
        .member("wall_rays", spawned.wall_rays)
        .member("wall_passed", spawned.wall_leaks);
    out.end_object();
}

void add_viewer(JsonWriter& out, const ViewerReport& viewer) {
    out.key("embree_viewer").begin_object();
    out.member("state", viewer.state)
        .member("pixels", viewer.pixels)
        .member("occlusion", viewer.occlusion)
        .member("geometry", viewer.geometry)
        .member("primitive", viewer.primitive)
        .member("normal", viewer.normal)
        .member("ties", viewer.ties);
    out.end_object();
}

void add_scene(JsonWriter& out, const CheckedScene& scene) {
    out.begin_object();
    out.member("name", scene.name).member("file", scene.file);
    out.member("triangles", scene.counts.triangles)
        .member("shapes", scene.counts.shapes)
        .member("in_world", scene.items_in_world)
        .member("rays", scene.rays);
    out.key("truth").begin_object();
    out.member("searched_through_everything", scene.truth.rays).member("wrong", scene.truth.wrong);
    out.end_object();
    out.key("formulas").begin_object();
    out.member("segments", scene.formulas.segments)
        .member("wrong", scene.formulas.wrong)
        .member("wrong_truth", scene.formulas.wrong_truth);
    out.end_object();
    out.key("pairs").begin_array();
    for (const PairFigures& pair : scene.pairs)
        add_pair(out, pair);
    out.end_array();
    add_twins(out, scene.twins);
    add_leaks(out, scene.leaks);
    add_spawned(out, scene.spawned);
    if (scene.viewer) add_viewer(out, *scene.viewer);
    out.key("faults").begin_array();
    for (const std::string& fault : scene.faults)
        out.value(fault);
    out.end_array();
    out.member("within_budget", scene.faults.empty());
    out.end_object();
}

}  // namespace

std::string crosscheck_json(const std::vector<CheckedScene>& scenes,
                            const std::vector<std::string>& warnings) {
    JsonWriter out;
    out.begin_object();
    out.member("version", OBSCURA_VERSION);
    out.key("budget").begin_object();
    out.member("mismatch_share", mismatch_share)
        .member("edge_ulp", edge_ulps)
        .member("depth_ulp", depth_ulps);
    out.end_object();
    out.key("scenes").begin_array();
    for (const CheckedScene& scene : scenes)
        add_scene(out, scene);
    out.end_array();
    out.key("warnings").begin_array();
    for (const std::string& warning : warnings)
        out.value(warning);
    out.end_array();
    out.end_object();
    return std::move(out).take();
}

}  // namespace obscura
