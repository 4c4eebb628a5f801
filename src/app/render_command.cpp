// app/render_command.cpp - the subcommand `obscura render`: load, prepare, render, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_command.h"

#include "app/memory_option.h"
#include "app/outcome.h"
#include "app/progress.h"
#include "app/render_job.h"
#include "app/signals.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "session/focus.h"
#include "session/image_parts.h"
#include "session/lighting.h"
#include "session/outputs.h"
#include "session/repeated_log.h"
#include "session/requested_camera.h"
#include "session/statistics.h"
#include "stages/dispatch.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace obscura::app {

namespace {

/// When an image's scene is posed.
PoseTimes times_of(const RenderRequest& request, const MovieFrame& frame, bool is_last) {
    PoseTimes times{frame.time_s, {}, is_last};
    if (request.shutter) {
        const double frame_s = 1 / request.fps;
        times.shutter = gltf::ShutterTimes{frame.time_s + request.shutter->open * frame_s,
                                           frame.time_s + request.shutter->close * frame_s,
                                           frame.time_s};
    }
    return times;
}

/// Times that a frame added to the sums.
FrameStatistics frame_statistics(const MovieFrame& frame,
                                 const RenderStatistics& before,
                                 const RenderStatistics& after) {
    return {frame.number.value_or(0),
            frame.time_s,
            after.load_s - before.load_s,
            after.build_s - before.build_s,
            after.render_s - before.render_s,
            after.write_s - before.write_s};
}

/// Reads the asset and the environment, once for all images.
Result<void> load(Job& job) {
    const gltf::LoadOptions& options = job.request.load;
    const bool has_time = options.time_s || job.request.frames || job.request.shutter;
    const Stopwatch loading;
    Result<AssetRenderer> renderer =
        AssetRenderer::open(job.request.scene, options, has_time, job.log);
    if (!renderer) return fail(renderer.error());
    job.renderer = std::move(*renderer);
    if (auto found = job.renderer->find_framed_nodes(job.request.camera); !found) return found;
    Result<LightingOptions> lighting = load_lighting(job.request, job.log);
    if (!lighting) return fail(lighting.error());
    job.lighting = std::move(*lighting);
    job.renderer->statistics().load_s = loading.seconds();
    return {};
}

/// Poses the asset; a sequence keeps the view of its first frame.
Result<void> pose(Job& job, const MovieFrame& frame, const Turn& turn, Log& log) {
    const PoseTimes times = times_of(job.request, frame, turn.is_last());
    if (auto posed = job.renderer->pose(times, log); !posed) return posed;
    if (job.request.segmentation) {
        if (auto fits = check_segmentation(job.renderer->scene()); !fits) return fits;
    }
    if (job.request.frames && job.request.frames->numbers.size() > 1 && turn.index == 0) {
        const Scene& scene = job.renderer->scene();
        const RenderOptions& options = job.request.options;
        CameraRequest& camera = job.request.camera;
        camera.framed = scene.bounds;
        camera.kept =
            automatic_framing(scene, camera, static_cast<double>(options.width) / options.height);
    }
    return {};
}

/// Whether --part-by frames leaves the frame with this index to another part.
bool is_of_another_part(const RenderRequest& request, size_t index) {
    if (!request.part || request.part_by != PartBy::frames) return false;
    return index % static_cast<size_t>(request.part->count) !=
           static_cast<size_t>(request.part->index);
}

/// The images to render. All parts of a sequence keep the view of its first frame, so that this is
/// posed though another part renders it.
std::vector<MovieFrame> frames_to_pose(const RenderRequest& request) {
    std::vector<MovieFrame> all = frames_of(request);
    std::vector<MovieFrame> out = {all.front()};
    for (size_t i = 1; i < all.size(); ++i) {
        if (!is_of_another_part(request, i)) out.push_back(std::move(all[i]));
    }
    return out;
}

/// Renders the images in turn.
Result<void> render_all(Job& job, Progress& progress) {
    const std::vector<MovieFrame> frames = frames_to_pose(job.request);
    const bool skips_first = is_of_another_part(job.request, 0);
    if (const Result<void> loaded = load(job); !loaded) return loaded;
    RenderStatistics& statistics = job.renderer->statistics();
    RepeatedLog later(job.log, SettingNames::options);
    for (size_t i = 0; i < frames.size(); ++i) {
        const RenderStatistics before = statistics;
        const Turn turn{i, frames.size()};
        Log& log = i == 0 ? job.log : later.begin();
        job.request.outputs = frames[i].outputs;
        job.request.segmentation = frames[i].segmentation;
        job.request.frame = frames[i].number;
        if (auto posed = pose(job, frames[i], turn, log); !posed) return posed;
        if (i == 0 && skips_first) continue;
        const Result<ChosenCamera> camera = job.renderer->prepare(job.request, job.lighting, log);
        if (!camera) return fail(camera.error());
        const Result<void> done = make_image(job, *camera, turn, log, progress);
        if (!done) return done;
        job.watch.begin_preparing();
        if (!frames[i].number) continue;
        statistics.frames.push_back(frame_statistics(frames[i], before, statistics));
        job.log.info(fmt::format("frame {} is written, {} of {}",
                                 *frames[i].number,
                                 statistics.frames.size(),
                                 frames.size() - (skips_first ? 1 : 0)));
    }
    progress.finish();
    return {};
}

/// --check: for every image, all steps before the BVH.
Result<void> check_all(Job& job) {
    if (const Result<void> loaded = load(job); !loaded) return loaded;
    const std::vector<MovieFrame> frames = frames_of(job.request);
    RepeatedLog later(job.log, SettingNames::options);
    for (size_t i = 0; i < frames.size(); ++i) {
        Log& log = i == 0 ? job.log : later.begin();
        if (auto posed = pose(job, frames[i], {i, frames.size()}, log); !posed) return posed;
        const Result<ChosenCamera> chosen =
            choose_unfocused_camera(job.renderer->scene(), job.request, log);
        if (!chosen) return fail(chosen.error());
        const Result<void> exposed = expose_display(*chosen, job.request, job.display, log);
        if (!exposed) return exposed;
    }
    if (!has_isa(job.request.isa)) return fail(missing_isa());
    job.log.info("checked: nothing forbids to render it; nothing was written");
    return {};
}

void log_summary(const RenderRequest& request, const RenderStatistics& statistics, Log& log) {
    std::string names;
    if (is_part_of_image(request)) {
        names = part_file(request.outputs.front(), *request.part).string();
    } else {
        for (const std::filesystem::path& output : request.outputs)
            names += (names.empty() ? "" : ", ") + output.string();
    }
    if (request.standard_output)
        names += (names.empty() ? "" : ", ") + std::string(standard_output_name);
    const double seconds = std::max(statistics.render_s, 1e-9);
    const auto millions = [&](uint64_t count) {
        return static_cast<double>(count) / seconds * 1e-6;
    };
    const std::string what =
        request.frames ? fmt::format("rendered {} frames", statistics.frames.size()) : "rendered";
    if (statistics.adaptive) {
        const SamplesTaken& taken = *statistics.adaptive;
        log.info(fmt::format("{} to {} samples a pixel, {:.1f} in the mean, to a noise of {:.4f}",
                             taken.least,
                             taken.most,
                             taken.mean(),
                             taken.noise));
    }
    log.info(fmt::format("{} in {:.2f} s: {:.2f} M paths/s, {:.2f} M rays/s; wrote {}",
                         what,
                         statistics.render_s,
                         millions(statistics.counters.paths),
                         millions(total_rays(statistics.counters)),
                         names));
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

Result<void> execute(const RenderRequest& request,
                     const NamedTexts& options,
                     const ImageParts* parts,
                     Watch& watch,
                     Log& log) {
    const Stopwatch total;
    if (auto set = use_memory_limit(request.max_memory, memory_bound()); !set) return set;
    if (auto writable = check_outputs(request); !writable) return writable;
    warn_of_lost_alpha(request, log);
    Result<std::optional<DisplayTransform>> display = make_display(request, log);
    if (!display) return fail(display.error());
    const ThreadLimit threads(request.threads);
    Job job{.log = log,
            .request = request,
            .options = options,
            .parts = parts,
            .watch = watch,
            .display = std::move(*display)};
    if (request.check) return check_all(job);
    Progress progress(request.verbosity, lines_of(request), request.farm);
    const Result<void> done = render_all(job, progress);
    if (!done) return done;
    RenderStatistics& statistics = job.renderer->statistics();
    statistics.threads = threads.threads();
    statistics.total_s = total.seconds();
    statistics.warnings = log.warnings();
    if (auto written = write_statistics(request, statistics); !written) return written;
    log_summary(request, statistics, log);
    return check_counters(statistics.counters, request);
}

}  // namespace

int run_render(const RenderArguments& arguments, const ImageParts* parts) {
    TerminalLog log(verbosity_of(arguments));
    Result<RenderRequest> request = make_render_request(arguments);
    if (!request) return report_failure(request.error(), log);
    const std::string scene = request->scene.string();
    Watch watch(scene, log, watch_times(request->long_run));
    const Result<void> loaded = load_requested_camera(*request, log);
    if (!loaded) return report_failure(loaded.error(), log);
    const Result<void> colored = use_color_space(*request, log);
    if (!colored) return report_failure(colored.error(), log);
    const Result<void> done = execute(*request, options_for_merge(arguments), parts, watch, log);
    watch.end();
    if (done) return report_success(scene, log);
    const int signal = received_stop_signal();
    if (done.error().id == "E-STOPPED" && signal != 0)
        return report_stop(signal, scene, done.error().message, log);
    tell_farm(done.error(), *request);
    return report_failure(done.error(), log);
}

}  // namespace obscura::app
