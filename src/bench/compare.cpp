// bench/compare.cpp - compares two benches and tells changes from chance.
// SPDX-License-Identifier: Apache-2.0
#include "bench/compare.h"

#include "base/file_bytes.h"
#include "base/json/json_read.h"
#include "base/json/json_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace obscura::bench {

namespace {

constexpr double min_change = 0.02;
constexpr size_t min_count = 3;

void add_view(const std::string& prefix, const ViewFigures& view, std::vector<Figure>& out) {
    out.push_back({prefix + "of_bare", view.of_bare});
    out.push_back({prefix + "render_s", view.render_s});
    out.push_back({prefix + "replay_s", view.replay_s});
    for (size_t i = 0; i < view.stage_s.size(); ++i)
        out.push_back({prefix + "stage_" + stage_names()[i] + "_s", view.stage_s[i]});
}

Spread exactly(size_t bytes) {
    const auto value = static_cast<double>(bytes);
    return {value, value, value, 1};
}

bool is_bytes(const Change& change) {
    return change.name.ends_with("_bytes");
}

bool more_is_better(const Change& change) {
    return change.name.ends_with("of_bare") || change.name.ends_with("per_s");
}

bool ranges_apart(const Spread& a, const Spread& b) {
    return a.high < b.low || b.high < a.low;
}

double relative_change(const Change& change) {
    const double before = change.before.median;
    return before != 0 ? change.after.median / before - 1 : 0;
}

tl::unexpected<Error> not_a_report(const std::filesystem::path& file, const std::string& why) {
    return fail(ExitCode::bad_resource,
                "E-BENCH-OLD",
                file.string(),
                why + "; expected a file that `obscura bench --json` wrote");
}

}  // namespace

std::vector<Figure> comparable_figures(const BenchReport& report) {
    std::vector<Figure> out;
    for (const SceneFigures& scene : report.scenes) {
        const std::string prefix = scene.name + "/";
        out.push_back({prefix + "load_s", scene.load.load_s});
        out.push_back({prefix + "decode_s", scene.load.decode_s});
        out.push_back({prefix + "prepare_s", scene.load.prepare_s});
        out.push_back({prefix + "bvh_s", scene.load.bvh_s});
        out.push_back({prefix + "load_of_bare", scene.load.of_bare});
        out.push_back({prefix + "bvh_bytes", exactly(scene.memory.bvh)});
        out.push_back({prefix + "scene_bytes", exactly(scene.memory.scene())});
        for (const ViewFigures& view : scene.views)
            add_view(prefix + view.name + "/", view, out);
        for (const ViewFigures& row : scene.by_threads) {
            const std::string threads = std::to_string(row.threads) + " threads/";
            out.push_back({prefix + row.name + "/" + threads + "render_s", row.render_s});
        }
        for (const ViewFigures& row : scene.by_isa)
            out.push_back({prefix + row.name + "/" + row.isa + "/render_s", row.render_s});
    }
    return out;
}

std::string circumstances_of(const BenchReport& report) {
    const Machine& m = report.machine;
    const BenchSettings& s = report.settings;
    return fmt::format("{} {} cores, Embree {}, {} {}, {}x{} {} spp depth {} {} {}",
                       m.cpu,
                       m.cores,
                       m.embree,
                       m.compiler,
                       m.build_type,
                       s.width,
                       s.height,
                       s.samples_per_pixel,
                       s.max_bounces,
                       s.integrator,
                       s.environment);
}

Result<OldReport> read_old_report(const std::filesystem::path& file) {
    const FileBytes whole = read_file_bytes(file, {});
    if (whole.fault != FileFault::none) return not_a_report(file, whole.reason);
    const std::string_view text(reinterpret_cast<const char*>(whole.bytes.data()),
                                whole.bytes.size());
    Log silent(Verbosity::quiet);
    const auto tree = parse_json_text(text, file.string(), silent);
    if (!tree) return not_a_report(file, tree.error().message);
    JsonFault fault{file.string(), {}};
    const JsonReader root(*tree, "", fault);
    root.require("figures");
    OldReport old;
    root.each("figures", [&](const JsonReader& figure, size_t) {
        for (const char* key : {"name", "median", "low", "high"})
            figure.require(key);
        const Spread value{figure.number("median", 0),
                           figure.number("low", 0),
                           figure.number("high", 0),
                           static_cast<size_t>(figure.number("count", 0))};
        old.figures.push_back({figure.text("name"), value});
    });
    old.circumstances = root.text("circumstances");
    old.standard = static_cast<int>(root.number("standard", 0));
    if (fault.error) return not_a_report(file, fault.error->message);
    return old;
}

std::vector<Change> compare(const std::vector<Figure>& before, const std::vector<Figure>& after) {
    std::vector<Change> changes;
    for (const Figure& figure : after) {
        const auto same_name = [&](const Figure& other) { return other.name == figure.name; };
        const auto found = std::find_if(before.begin(), before.end(), same_name);
        if (found != before.end()) changes.push_back({figure.name, found->value, figure.value});
    }
    return changes;
}

std::string_view verdict(const Change& change) {
    const bool rose = change.after.median > change.before.median;
    if (is_bytes(change)) {
        if (change.after.median == change.before.median) return "the same";
        return rose ? "larger" : "smaller";
    }
    if (std::min(change.before.count, change.after.count) < min_count) {
        return "too few measurements";
    }
    const bool counts = ranges_apart(change.before, change.after) &&
                        std::fabs(relative_change(change)) > min_change;
    if (!counts) return "within noise";
    return rose == more_is_better(change) ? "faster" : "slower";
}

std::string compare_table(const std::vector<Change>& changes) {
    std::string out = fmt::format("\n{:<44} {:>12} {:>8} {:>12} {:>8} {:>9}  verdict\n",
                                  "compared with the earlier report",
                                  "before",
                                  "spread",
                                  "now",
                                  "spread",
                                  "change");
    for (const Change& change : changes) {
        out += fmt::format("{:<44} {:>12.6g} {:>6.1f} % {:>12.6g} {:>6.1f} % {:>+7.1f} %  {}\n",
                           change.name,
                           change.before.median,
                           100 * change.before.relative(),
                           change.after.median,
                           100 * change.after.relative(),
                           100 * relative_change(change),
                           verdict(change));
    }
    return out;
}

}  // namespace obscura::bench
