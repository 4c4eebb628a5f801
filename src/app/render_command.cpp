// app/render_command.cpp - the subcommand `obscura render`: load, prepare, render, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_command.h"

#include "app/distinct_files.h"
#include "app/exposure_groups.h"
#include "app/list_options.h"
#include "app/listed_poses.h"
#include "app/memory_option.h"
#include "app/other_parts.h"
#include "app/outcome.h"
#include "app/progress.h"
#include "app/render_job.h"
#include "app/signals.h"
#include "app/unused_options.h"
#include "base/atomic_file.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/priority.h"
#include "base/stopwatch.h"
#include "session/image_parts.h"
#include "session/manifest.h"
#include "session/outputs.h"
#include "session/statistics.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <span>

namespace obscura::app {

namespace {

/// Images that were there, for the summary: "; 3 were there".
std::string skipped_text(size_t skipped) {
    return skipped == 0 ? "" : fmt::format("; {} {} there", skipped, skipped == 1 ? "was" : "were");
}

/// "rendered 12 images"; of a single one "rendered".
std::string rendered_text(const Job& job) {
    const RenderRequest& request = job.whole;
    if (!request.frames && !request.lists.is_asked()) return "rendered";
    const char* const unit = request.lists.is_asked() ? "image" : "frame";
    return fmt::format("rendered {} {}{}", job.rendered, unit, job.rendered == 1 ? "" : "s");
}

void log_summary(const Job& job, const RenderStatistics& statistics) {
    const RenderRequest& request = job.whole;
    Log& log = job.log;
    std::string names;
    if (is_part_of_image(request)) {
        names = part_file(request.outputs.front(), *request.part).string();
    } else {
        // Of a single image the names are known; of many, the pattern tells them.
        const bool is_one = job.rendered == 1 && job.skipped == 0;
        for (const std::filesystem::path& output : is_one ? job.request.outputs : request.outputs)
            names += (names.empty() ? "" : ", ") + output.string();
    }
    if (request.standard_output)
        names += (names.empty() ? "" : ", ") + std::string(standard_output_name);
    const double seconds = std::max(statistics.render_s, 1e-9);
    const auto millions = [&](uint64_t count) {
        return static_cast<double>(count) / seconds * 1e-6;
    };
    if (statistics.adaptive) {
        const SamplesTaken& taken = *statistics.adaptive;
        const std::string noise =
            taken.noise ? fmt::format(", to a noise of {:.4f}", *taken.noise) : "";
        log.info(fmt::format("{} to {} samples a pixel, {:.1f} in the mean{}",
                             taken.least,
                             taken.most,
                             taken.mean(),
                             noise));
    }
    log.info(fmt::format("{} in {:.2f} s: {:.2f} M paths/s, {:.2f} M rays/s; wrote {}{}",
                         rendered_text(job),
                         statistics.render_s,
                         millions(statistics.counters.paths),
                         millions(total_rays(statistics.counters)),
                         names,
                         skipped_text(job.skipped)));
}

Result<void> write_statistics(const RenderRequest& request, const RenderStatistics& statistics) {
    if (!request.statistics) return {};
    const std::string text = statistics_json(request, statistics);
    return write_file_atomically(*request.statistics, std::as_bytes(std::span(text)));
}

Result<void> check_counters(const RenderCounters& counters, const RenderRequest& request) {
    if (!too_many_nonfinite(counters)) return {};
    return fail(ExitCode::too_many_nonfinite,
                "E-NONFINITE",
                request.scene.string(),
                fmt::format("{} of {} samples were not finite and count as zero; the pictures were "
                            "written; expected at most one in a million",
                            counters.nonfinite_samples,
                            counters.paths));
}

/// Where lines for other programs go: standard output, unless an image goes there.
std::FILE* lines_of(const RenderRequest& request) {
    return request.standard_output ? stderr : stdout;
}

/// Tells the farm manager why there is no image, where it asks that of the program.
/// Source  Open Job Description, "How Jobs Are Run", 2023-09: openjd_fail
void tell_farm(const Error& error, const RenderRequest& request) {
    if (request.farm != FarmManager::openjd) return;
    std::fputs(("openjd_fail: " + failure_text(error) + "\n").c_str(), lines_of(request));
}

WatchTimes watch_times(const LongRun& run) {
    WatchTimes out{run.time_limit_s, {}, run.snapshot_interval_s};
    if (run.has_checkpoint) out.checkpoint_interval_s = run.checkpoint_interval_s;
    return out;
}

struct UsedMachine {
    int threads = 0;
    double seconds = 0;
};

/// Writes --stats and the summary for people.
Result<void> tell_statistics(Job& job, const UsedMachine& used) {
    RenderStatistics none;
    RenderStatistics& statistics = job.renderer ? job.renderer->statistics() : none;
    statistics.threads = used.threads;
    statistics.total_s = used.seconds;
    statistics.warnings = job.log.warnings();
    if (auto written = write_statistics(job.whole, statistics); !written) return written;
    if (job.renderer) log_summary(job, statistics);
    return check_counters(statistics.counters, job.whole);
}

/// --dry-run
Result<void> list_images_of(const SceneRun& run, Watch& watch, KeptForLater& kept, Log& log) {
    Job job{.log = log,
            .whole = run.request,
            .request = run.request,
            .options = run.options,
            .watch = watch,
            .kept = kept};
    return list_all(job);
}

/// Out   skipped: images that were there already
Result<void> execute(
    const SceneRun& run, Watch& watch, KeptForLater& kept, Log& log, size_t& skipped) {
    const RenderRequest& request = run.request;
    const Stopwatch total;
    const ThreadLimit threads(request.threads);
    if (auto begun = start_threads_ahead(); !begun) return begun;
    if (auto set = use_memory_limit(request.max_memory, memory_bound()); !set) return set;
    if (request.lists.lists_only) return list_images_of(run, watch, kept, log);
    if (auto writable = check_outputs(request); !writable) return writable;
    if (!request.lists.needs_asset()) {
        const Result<ImageList> list = list_images(request, {});
        if (!list) return fail(list.error());
        if (auto fits = check_files(request, list->images); !fits) return fits;
    }
    open_writers_ahead(request);
    warn_of_lost_alpha(request, log);
    Result<std::optional<DisplayTransform>> display = make_display(request, log);
    if (!display) return fail(display.error());
    Job job{.log = log,
            .whole = request,
            .request = request,
            .options = run.options,
            .parts = run.parts,
            .watch = watch,
            .kept = kept,
            .hooks = run.hooks,
            .display = std::move(*display),
            .threads = threads.threads()};
    if (request.check) return check_all(job);
    Progress progress(request.verbosity, lines_of(request), request.farm);
    Result<void> done = render_all(job, progress);
    skipped = job.skipped;
    if (done) done = tell_statistics(job, {threads.threads(), total.seconds()});
    leave_asset(job);
    return done;
}

/// Renders the images of one scene.
///
/// Out   skipped: images that were there already
Result<void> render_scene(SceneRun& run, KeptForLater& kept, Log& log, size_t& skipped) {
    RenderRequest& request = run.request;
    Watch watch(request.scene.string(), log, watch_times(request.long_run));
    if (auto read = read_named_files(request, log); !read) return read;
    if (run.parts != nullptr && run.parts->are_of_samples()) request.part_by = PartBy::samples;
    const Result<void> done = execute(run, watch, kept, log, skipped);
    watch.end();
    return done;
}

/// Takes the time that is over from a command's limit.
///
/// Errors  75 E-TIME-LIMIT none is left
Result<void> shorten_time_limit(RenderRequest& request, double seconds) {
    if (!request.long_run.time_limit_s) return {};
    double& limit_s = *request.long_run.time_limit_s;
    limit_s -= seconds;
    if (limit_s > 0) return {};
    return fail(ExitCode::stopped_early,
                "E-TIME-LIMIT",
                request.scene.string(),
                "the time is over before this scene was begun");
}

/// True when the whole command is to stop.
bool stops_all(const Error& error) {
    return error.id == "E-STOPPED" || error.id == "E-TIME-LIMIT";
}

/// Tells the manifest of a rendering that failed before it could do so itself.
void note_failure(const RenderRequest& request, const Error& error) {
    if (!request.lists.manifest || request.lists.lists_only || request.check) return;
    const ListedImage none;
    ImageOutcome outcome{none, View{}};
    outcome.error = error;
    if (Result<Manifest> manifest = Manifest::open(*request.lists.manifest, false))
        (void)manifest->add(manifest_line(request, outcome));
}

/// Drops what no later rendering needs.
void drop_unneeded(KeptForLater& kept, std::span<const SceneRun> later) {
    const auto is_of_any = [&](const auto& fits) {
        return std::any_of(
            later.begin(), later.end(), [&](const SceneRun& run) { return fits(run.request); });
    };
    std::erase_if(kept.environments, [&](const auto& entry) {
        return !is_of_any(
            [&](const RenderRequest& request) { return environment_key(request) == entry.first; });
    });
    kept.assets.close_unless([&](const std::filesystem::path& scene) {
        return is_of_any([&](const RenderRequest& request) { return request.scene == scene; });
    });
}

/// Whether an asset that was opened for one rendering serves another, as far as that is known
/// before their files are read.
bool opens_alike(const RenderRequest& a, const RenderRequest& b) {
    return a.scene == b.scene && a.load == b.load && a.isa == b.isa &&
           a.color_space == b.color_space;
}

/// Whether what follows a rendering is known to be rendered here.
bool knows_what_follows(const RenderRequest& request) {
    return !request.long_run.skips_existing && !request.part && !request.check &&
           !request.lists.lists_only;
}

/// Renders scene after scene; one that fails does not end the rest, unless the program is to stop.
class SceneRuns {
public:
    SceneRuns(std::vector<SceneRun>& runs, Log& log) : runs_(runs), log_(log) {
        meter_exposures(runs_, kept_, log_);
        others_.emplace(runs_);
        drop_unneeded(kept_, runs_);
        for (const SceneRun& run : runs)
            time_limits_s_.push_back(run.request.long_run.time_limit_s);
        // What one rendering reads no other may write.
        std::error_code error;
        for (const SceneRun& run : runs) {
            for (const std::filesystem::path& file : files_read(run.request))
                kept_.written.emplace(std::filesystem::absolute(file, error).lexically_normal(),
                                      SIZE_MAX);
        }
    }

    /// What others hold comes once more in the end.
    void render() {
        const RenderRequest& first = runs_.front().request;
        if (first.display_server && !first.lists.lists_only)
            kept_.viewer = std::make_unique<DisplayServer>(*first.display_server, log_);
        render_all_scenes();
        if (kept_.viewer) kept_.viewer->finish(received_stop_signal() != 0);
    }

    bool is_stopped() const { return !failures_.empty() && stops_all(failures_.back()); }
    /// Ends the program where a thread still reads ahead, which nobody would wait for.
    int end_stopped(int code) const {
        if (!kept_.assets.is_reading()) return code;
        std::fflush(nullptr);
        std::_Exit(code);
    }
    size_t skipped() const { return skipped_; }
    std::vector<Error>& failures() { return failures_; }

private:
    void render_all_scenes() {
        for (size_t i = 0; i < runs_.size() && !is_stopped(); ++i) {
            others_->note_files_before(i, kept_);
            render_one(i, runs_.size() > 1);
        }
        const std::vector<size_t> locked = std::move(locked_);
        for (size_t i = 0; i < locked.size() && !is_stopped(); ++i)
            render_one(locked[i], false);
    }

    /// In   comes_again: where others hold what is left
    void render_one(size_t i, bool comes_again) {
        RenderRequest& request = runs_[i].request;
        request.lists.keeps_asset = comes_again && keeps_asset(i);
        kept_.read_ahead = {};
        if (comes_again) kept_.read_ahead = [this, i](int threads) { read_ahead(i + 1, threads); };
        request.long_run.time_limit_s = time_limits_s_[i];
        kept_.run = i;
        kept_.has_manifest = false;
        // What one scene warns of stands in its images' headers, and not in the others'.
        Log own(log_.verbosity() == Verbosity::verbose ? Verbosity::verbose : Verbosity::normal,
                passed_to(log_),
                SettingNames::options);
        size_t there = 0;
        Result<void> done = shorten_time_limit(request, total_.seconds());
        if (done) done = render_scene(runs_[i], kept_, own, there);
        drop_unneeded(kept_, std::span(runs_).subspan(i + 1));
        skipped_ += there;
        if (done) return;
        if (comes_again && done.error().id == "E-LOCKED") {
            skipped_ -= there;  // they will be there again
            locked_.push_back(i);
            return;
        }
        Error error = at_its_place(std::move(done.error()), runs_[i].places);
        for (Error& also : error.also)
            also = at_its_place(std::move(also), runs_[i].places);
        add_failure(i, std::move(error));
    }

    bool keeps_asset(size_t i) const {
        return std::any_of(
            runs_.begin() + static_cast<long>(i) + 1, runs_.end(), [&](const SceneRun& later) {
                return opens_alike(runs_[i].request, later.request);
            });
    }

    /// Begins to read the asset of a rendering while the one before goes on.
    void read_ahead(size_t i, int threads) {
        if (i >= runs_.size() || threads < 2) return;
        RenderRequest request = runs_[i].request;
        const bool is_open = request.scene == runs_[i - 1].request.scene;
        if (is_open || !knows_what_follows(request)) return;
        if (memory_share_taken() > max_share_of_kept) return;
        request.lists.keeps_asset = keeps_asset(i);
        kept_.assets.read_ahead(std::move(request), threads);
    }

    void add_failure(size_t i, Error error) {
        const RenderRequest& request = runs_[i].request;
        const bool is_of_run = !stops_all(error) && error.id != "E-LOCKED";
        if (is_of_run && !kept_.has_manifest) note_failure(request, error);
        if (is_of_run && i + 1 < runs_.size()) {
            log_.warn(request.scene.string(),
                      fmt::format("this scene fails: {}: {} [{}]; the others go on",
                                  error.where,
                                  error.message,
                                  error.id));
        }
        failures_.push_back(std::move(error));
    }

    std::vector<SceneRun>& runs_;
    std::optional<OtherParts> others_;
    Log& log_;
    std::vector<std::optional<double>> time_limits_s_;  ///< of the whole command
    const Stopwatch total_;
    KeptForLater kept_;
    std::vector<size_t> locked_;
    size_t skipped_ = 0;
    std::vector<Error> failures_;
};

Error all_failures(std::vector<Error> failures, size_t runs) {
    const size_t count = failures.size();
    Error out = joined(std::move(failures));
    if (runs > 1 && out.code != ExitCode::stopped_early)
        out.message =
            fmt::format("{} of {} renderings failed; the first: {}", count, runs, out.message);
    return out;
}

/// Makes the manifest, anew unless it holds what others have told.
Result<void> begin_manifest(const RenderRequest& request) {
    const ListRequest& lists = request.lists;
    const bool is_shared = request.part || request.long_run.skips_existing || lists.shares_manifest;
    if (!lists.manifest || lists.lists_only || request.check) return {};
    const Result<Manifest> manifest = Manifest::open(*lists.manifest, !is_shared);
    if (!manifest) return fail(manifest.error());
    return {};
}

}  // namespace

int run_render(const RenderArguments& arguments, const ImageParts* parts) {
    TerminalLog log(verbosity_of(arguments));
    std::vector<SceneRun> runs;
    Result<std::vector<RenderArguments>> all = arguments_of_scenes(arguments);
    if (!all) return report_failure(all.error(), log);
    for (RenderArguments& one : *all) {
        Result<RenderRequest> request = make_render_request(one);
        if (!request) return report_failure(request.error(), log);
        // Merging repeats the options of the parts, which may have had other outputs.
        if (runs.empty() && parts == nullptr)
            warn_of_unused_options(unused_options(one, *request), log);
        runs.push_back({std::move(*request), options_for_merge(one), parts});
    }
    const std::string where = runs.size() == 1 ? runs.front().request.scene.string()
                                               : fmt::format("{} scenes", runs.size());
    return run_scenes(runs, where, log);
}

int run_scenes(std::vector<SceneRun>& runs,
               const std::string& where,
               Log& log,
               const std::function<Result<void>()>& finish) {
    if (auto fits = check_scenes(runs); !fits) return report_failure(fits.error(), log);
    const StopOnSignal signals(StopOnSignal::Kind::farm_too);  // also between renderings
    const RenderRequest& first = runs.front().request;
    if (first.gives_way) give_way_to_others();  // the threads that follow, too
    if (auto begun = begin_manifest(first); !begun) return report_failure(begun.error(), log);
    SceneRuns all(runs, log);
    all.render();
    const int signal_before = received_stop_signal();
    const std::string counts =
        first.long_run.skips_existing ? fmt::format(" skipped={}", all.skipped()) : "";
    const Result<void> finished = all.is_stopped() ? Result<void>() : finish();
    const bool is_stopped = all.is_stopped();
    if (signal_before == 0 && received_stop_signal() != 0)
        return report_stop(received_stop_signal(), where, "all images are finished", log);
    std::vector<Error>& failures = all.failures();
    if (failures.empty() && !finished) return report_failure(finished.error(), log, counts);
    if (failures.empty()) return report_success(where, log, counts);
    const int signal = received_stop_signal();
    const Error& last = failures.back();
    if (last.id == "E-STOPPED" && signal != 0)
        return all.end_stopped(report_stop(signal, where, last.message, log));
    Error error = all_failures(std::move(failures), runs.size());
    if (!finished) error.also.push_back(finished.error());
    tell_farm(error, first);
    const int code = report_failure(error, log, counts);
    return is_stopped ? all.end_stopped(code) : code;
}

}  // namespace obscura::app
