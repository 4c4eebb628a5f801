// app/bench_command.cpp - the subcommand `obscura bench`: measure, print, compare, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_command.h"

#include "app/bench_standard.h"
#include "app/memory_option.h"
#include "app/outcome.h"
#include "app/signals.h"
#include "app/skipped_scenes.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/peak_memory.h"
#include "bench/machine.h"
#include "bench/measure_load.h"
#include "bench/measure_view.h"
#include "bench/report_json.h"
#include "bench/report_svg.h"
#include "render/integrators.h"
#include "session/lighting.h"
#include "session/statistics.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace obscura::app {

namespace {

/// The measuring of one scene.
struct SceneBench {
    const BenchRequest& request;
    const RenderRequest& scene;
    Log& log;
    bench::SceneFigures figures = {};
    bool nonfinite = false;
};

Result<bench::ViewFigures> measure(SceneBench& bench,
                                   const PreparedScene& prepared,
                                   const BenchView& view,
                                   int threads) {
    const ThreadLimit limit(threads);
    const StopOnSignal stop;
    bench::ViewTask task;
    task.scene = &prepared;
    task.camera = view.camera;
    task.options = bench.scene.options;
    task.repeat = bench.request.repeat;
    task.threads = threads;
    task.after_first = [&] {
        bench.figures.memory.peak = std::max(bench.figures.memory.peak, peak_memory_bytes());
    };
    reset_peak_memory();
    Result<bench::ViewFigures> figures = bench::measure_view(task, stop.flag());
    if (!figures) return figures;
    figures->name = view.name;
    figures->description = view.description;
    figures->camera = view.numbers;
    figures->coverage = view.coverage;
    bench.nonfinite = bench.nonfinite || too_many_nonfinite(figures->counters);
    for (const std::string& doubt : bench::doubts_about(*figures))
        bench.log.warn(bench.figures.name + "/" + view.name, doubt);
    bench.log.info(fmt::format("{}/{}, {}, {} threads: {:.1f} % of bare Embree",
                               bench.figures.name,
                               view.name,
                               figures->isa,
                               threads,
                               100 * figures->of_bare.median));
    return figures;
}

/// The main figures of every view, and entries for each number of threads.
Result<void> measure_threads(SceneBench& bench,
                             const PreparedScene& prepared,
                             const std::vector<BenchView>& views) {
    const std::vector<int>& counts = bench.request.threads;
    std::vector<bench::ViewFigures>& rows = bench.figures.by_threads;
    for (const BenchView& view : views) {
        const size_t first_row = rows.size();
        for (const int threads : counts) {
            Result<bench::ViewFigures> figures = measure(bench, prepared, view, threads);
            if (!figures) return fail(figures.error());
            if (threads == counts.front()) bench.figures.views.push_back(*figures);
            if (counts.size() > 1) rows.push_back(std::move(*figures));
        }
        std::reverse(rows.begin() + static_cast<std::ptrdiff_t>(first_row), rows.end());
    }
    return {};
}

/// Entries for each instruction set but the first, whose figures exist already.
Result<void> measure_isas(SceneBench& bench,
                          const PreparedScene& prepared,
                          const std::vector<BenchView>& views) {
    const std::vector<Isa>& isas = bench.request.isas;
    if (isas.size() < 2) return {};
    bench.figures.by_isa = bench.figures.views;
    Log silent(Verbosity::quiet);
    for (size_t i = 1; i < isas.size(); ++i) {
        Result<LightingOptions> lighting = load_lighting(bench.scene, silent);
        if (!lighting) return fail(lighting.error());
        const Result<PreparedScene> other =
            PreparedScene::create(prepared.scene(), *lighting, isas[i], silent);
        if (!other) return fail(other.error());
        for (const BenchView& view : views) {
            Result<bench::ViewFigures> figures =
                measure(bench, *other, view, bench.request.threads.front());
            if (!figures) return fail(figures.error());
            bench.figures.by_isa.push_back(std::move(*figures));
        }
    }
    return {};
}

Result<std::string> measure_scene(SceneBench& bench) {
    bench.figures.file = bench.scene.scene.string();
    bench.log.info("measuring " + bench.figures.file);
    Result<LightingOptions> lighting = load_lighting(bench.scene, bench.log);
    if (!lighting) return fail(lighting.error());
    const bench::LoadTask task{bench.scene.scene,
                               bench.scene.load,
                               std::move(*lighting),
                               bench.request.isas.front(),
                               bench.request.repeat};
    const Result<bench::LoadedScene> loaded = bench::measure_load(task, bench.log);
    if (!loaded) return fail(loaded.error());
    bench.figures.load = loaded->figures;
    bench.figures.memory = loaded->memory;
    const auto views =
        choose_bench_views(loaded->scene, bench.scene, bench.request.views, bench.log);
    if (!views) return fail(views.error());
    const Result<void> main = measure_threads(bench, loaded->scene, *views);
    if (!main) return fail(main.error());
    bench.figures.memory.film = bench.figures.views.front().film_bytes;
    const Result<void> isas = measure_isas(bench, loaded->scene, *views);
    if (!isas) return fail(isas.error());
    return loaded->scene.embree_version();
}

/// The file's name without extension; the whole path where an earlier scene has that name.
std::string free_name(const std::filesystem::path& file,
                      const std::vector<bench::SceneFigures>& taken) {
    const std::string name = file.stem().string();
    const auto is_taken = [&](const bench::SceneFigures& scene) { return scene.name == name; };
    return std::any_of(taken.begin(), taken.end(), is_taken) ? file.string() : name;
}

bench::BenchSettings settings_of(const BenchRequest& request) {
    const RenderRequest& scene = request.scenes.front();
    bench::BenchSettings out;
    out.width = scene.options.width;
    out.height = scene.options.height;
    out.samples_per_pixel = scene.options.samples_per_pixel;
    out.max_bounces = scene.options.max_bounces;
    out.seed = scene.options.seed;
    out.integrator = entry_of(scene.options.integrator).name;
    out.environment = scene.environment.value_or("").string();
    out.repeat = request.repeat;
    return out;
}

/// Everything that can fail early does so before the first scene is loaded.
Result<bench::OldReport> check_files(const BenchRequest& request) {
    for (const auto* output : {&request.json, &request.plot}) {
        if (!*output) continue;
        if (auto writable = check_file_can_be_written(**output); !writable) {
            return fail(writable.error());
        }
    }
    for (const Isa isa : request.isas) {
        if (!has_isa(isa)) return fail(missing_isa());
    }
    if (!request.compare) return bench::OldReport{};
    return bench::read_old_report(*request.compare);
}

Result<void> write_text(const std::optional<std::filesystem::path>& file, const std::string& text) {
    if (!file) return {};
    return write_file_atomically(*file, std::as_bytes(std::span(text)));
}

Result<void> deliver(const BenchRequest& request,
                     const bench::BenchReport& report,
                     const bench::OldReport& old,
                     Log& log) {
    std::string text = bench::bench_table(report);
    std::vector<bench::Change> changes;
    if (request.compare) {
        if (old.circumstances != bench::circumstances_of(report)) {
            log.warn(request.compare->string(),
                     "measured under other circumstances: " + old.circumstances + "; now " +
                         bench::circumstances_of(report));
        }
        changes = bench::compare(old.figures, bench::comparable_figures(report));
        text += bench::compare_table(changes);
    }
    if (auto printed = print_output(text); !printed) return printed;
    if (auto written = write_text(request.json, bench::bench_json(report, changes)); !written) {
        return written;
    }
    return request.plot ? write_text(request.plot, bench::bench_svg(report)) : Result<void>();
}

Result<void> execute(const BenchRequest& request, Log& log) {
    const Result<bench::OldReport> old = check_files(request);
    if (!old) return fail(old.error());
    if (request.standard) return run_standard(request, *old, log);
    const ThreadLimit threads(request.threads.front());
    if (auto begun = start_threads_ahead(); !begun) return begun;
    bench::BenchReport report;
    report.machine = bench::describe_machine();
    for (const std::string& doubt : bench::doubts_about(report.machine, request.threads))
        log.warn("bench", doubt);
    report.settings = settings_of(request);
    bool nonfinite = false;
    SkippedScenes skipped(request.scenes.size(), log);
    for (const RenderRequest& scene : request.scenes) {
        SceneBench bench{request, scene, log};
        bench.figures.name = free_name(scene.scene, report.scenes);
        const Result<std::string> embree = measure_scene(bench);
        if (!embree && skipped.skip(embree.error())) continue;
        if (!embree) return fail(embree.error());
        report.machine.embree = *embree;
        report.scenes.push_back(std::move(bench.figures));
        nonfinite = nonfinite || bench.nonfinite;
    }
    if (report.scenes.empty()) return skipped.result();
    report.warnings = log.warnings();
    if (auto delivered = deliver(request, report, *old, log); !delivered) return delivered;
    if (!nonfinite) return skipped.result();
    return fail(ExitCode::too_many_nonfinite,
                "E-NONFINITE",
                "bench",
                "more than one sample in a million was not finite; the report was written");
}

}  // namespace

int run_bench(const BenchArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    const Result<BenchRequest> request = make_bench_request(arguments);
    if (!request) return report_failure(request.error(), log);
    const Result<void> done = execute(*request, log);
    if (done) return report_success("bench", log);
    if (done.error().id == "E-STOPPED" && received_stop_signal() != 0) {
        return report_stop(received_stop_signal(), "bench", "", log);
    }
    return report_failure(done.error(), log);
}

}  // namespace obscura::app
