// app/render_command.cpp - the subcommand `obscura render`: load, prepare, render, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_command.h"

#include "app/autofocus.h"
#include "app/lighting.h"
#include "app/outcome.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/requested_camera.h"
#include "app/signals.h"
#include "app/statistics.h"
#include "app/stroke_scaling.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "gltf/load.h"
#include "render/enclosed_lights.h"
#include "render/integrators.h"
#include "scene/scene_memory.h"
#include "stages/dispatch.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace obscura {

namespace {

/// Later frames say mostly what the first one said: only what is new goes to the command's log.
class RepeatedLog {
public:
    explicit RepeatedLog(Log& log) : log_(log) {}
    ~RepeatedLog() { end(); }
    RepeatedLog(const RepeatedLog&) = delete;
    RepeatedLog& operator=(const RepeatedLog&) = delete;

    /// The log of the next frame.
    Log& begin() { return own_.emplace(Verbosity::quiet); }
    void end() {
        if (!own_) return;
        const std::vector<std::string> told = log_.warnings();
        for (const std::string& line : own_->warnings()) {
            if (std::find(told.begin(), told.end(), line) != told.end()) continue;
            const size_t colon = line.find(": ");
            log_.warn(line.substr(0, colon), line.substr(colon + 2));
        }
        own_.reset();
    }

private:
    Log& log_;
    std::optional<Log> own_;
};

/// One command from the request to the statistics.
struct Job {
    Log& log;               ///< the command's; frames may have their own
    RenderRequest request;  ///< its outputs and camera.framed change from frame to frame
    std::optional<DisplayTransform> display;
    std::optional<PosedAsset> asset;
    std::optional<PreparedScene> prepared;  ///< of the latest picture
    LightingOptions lighting;
    Degraded degraded;  ///< what the latest scene lacks
    RenderStatistics statistics;
    std::optional<StopOnSignal> stop;  ///< until the first picture a signal ends the program
    UnsetArray<float> film_memory;     ///< of the latest picture, for the next one
};

/// Which of so many pictures is rendered.
struct Turn {
    size_t index;
    size_t count;
    bool is_last() const { return index + 1 == count; }
};

Result<Scene> pose(Job& job, const MovieFrame& frame, const Turn& turn, Log& log) {
    const std::optional<ShutterFractions>& shutter = job.request.shutter;
    if (!shutter) return job.asset->scene_at(frame.time_s, turn.is_last(), log);
    const double frame_s = 1 / job.request.fps;
    return job.asset->scene_between(
        {frame.time_s + shutter->open * frame_s, frame.time_s + shutter->close * frame_s},
        turn.is_last(),
        log);
}

/// Poses the asset, chooses the camera, and builds what rendering reads and the picture before has
/// not left; frees the asset after its last pose.
Result<ChosenCamera> prepare(Job& job, const MovieFrame& frame, const Turn& turn, Log& log) {
    RenderStatistics& statistics = job.statistics;
    const Stopwatch loading;
    Result<Scene> scene = pose(job, frame, turn, log);
    if (!scene) return fail(scene.error());
    job.degraded = job.asset->degraded();
    add_degraded(job.degraded, statistics.degraded);
    if (turn.is_last()) job.asset.reset();
    statistics.load_s += loading.seconds();
    statistics.parse_s += scene->info.parse_seconds;
    statistics.decode_s += scene->info.decode_seconds;
    statistics.geometry_bytes = geometry_bytes(*scene);
    statistics.texture_bytes = texture_bytes(*scene);
    if (turn.count > 1 && turn.index == 0) job.request.camera.framed = scene->bounds;
    const Result<void> scaled = scale_strokes(job.request, *scene);
    if (!scaled) return fail(scaled.error());
    Result<ChosenCamera> camera = choose_unfocused_camera(*scene, job.request, log);
    if (!camera) return fail(camera.error());

    if (job.prepared) {
        const Result<void> updated = job.prepared->update(std::move(*scene), job.lighting, log);
        if (!updated) return fail(updated.error());
    } else {
        Result<PreparedScene> created =
            PreparedScene::create(std::move(*scene), job.lighting, job.request.isa, log);
        if (!created) return fail(created.error());
        job.prepared = std::move(*created);
    }
    const PreparedScene& prepared = *job.prepared;
    if (!is_quantity(job.request.options.integrator)) {
        const auto& eye = camera->camera.world_from_camera.m;
        warn_of_enclosed_lights(prepared, {eye[0][3], eye[1][3], eye[2][3]}, log);
    }
    statistics.build_s += prepared.build_seconds().all;
    statistics.bvh_bytes = prepared.bvh_bytes();
    statistics.isa = prepared.isa_name();
    statistics.embree = prepared.embree_version();
    return std::move(*camera);
}

/// Renders, then writes the pictures; a signal stops it between two tiles or two files.
Result<void> render_and_write(
    Job& job, ChosenCamera& camera, const Turn& turn, Log& log, Progress& progress) {
    const RenderRequest& request = job.request;
    const PreparedScene& scene = *job.prepared;
    RenderStatistics& statistics = job.statistics;
    RenderOptions options = request.options;
    if (auto focused = focus(scene, request, log, camera); !focused) return focused;
    options.moving_camera = camera.moving;
    options.film_memory = &job.film_memory;
    if (auto exposed = expose_display(camera, request, job.display, log); !exposed) return exposed;

    if (!job.stop) {
        job.stop.emplace();
        progress.begin();
    }
    const auto on_progress = [&](double share) {
        progress.update((static_cast<double>(turn.index) + share) /
                        static_cast<double>(turn.count));
    };
    Result<RenderResult> result =
        render(scene, camera.camera, options, on_progress, job.stop->flag());
    if (!result) return fail(result.error());
    statistics.render_s += result->render_seconds;
    add_counters(result->counters, statistics.counters);
    statistics.film_bytes = result->film.pixels.size() * sizeof(float);

    const Stopwatch writing;
    FinishedPicture finished;
    finished.metadata = make_metadata(request, scene, camera, result->render_seconds, job.log);
    if (request.load.lenient) {
        finished.metadata.extra.emplace_back("degraded", degraded_text(job.degraded));
    }
    Film& film = result->film;
    finished.picture = {film.width, film.height, std::move(film.channels), std::move(film.pixels)};
    const Result<void> written = write_outputs(request, finished, job.display, job.stop->flag());
    statistics.write_s += writing.seconds();
    job.film_memory = std::move(finished.picture.pixels);
    return written;
}

/// What a frame has added to the sums.
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

/// Reads the asset and the environment, once for all pictures.
Result<void> load(Job& job) {
    const LoadOptions& options = job.request.load;
    const bool has_time = options.time_s || job.request.frames || job.request.shutter;
    const Stopwatch loading;
    Result<PosedAsset> asset = PosedAsset::open(job.request.scene, options, has_time, job.log);
    if (!asset) return fail(asset.error());
    job.asset = std::move(*asset);
    Result<LightingOptions> lighting = load_lighting(job.request, job.log);
    if (!lighting) return fail(lighting.error());
    job.lighting = std::move(*lighting);
    job.statistics.load_s = loading.seconds();
    return {};
}

/// Renders one picture after the other.
Result<void> render_all(Job& job, Progress& progress) {
    const std::vector<MovieFrame> frames = frames_of(job.request);
    if (const Result<void> loaded = load(job); !loaded) return loaded;
    RepeatedLog later(job.log);
    for (size_t i = 0; i < frames.size(); ++i) {
        const RenderStatistics before = job.statistics;
        const Turn turn{i, frames.size()};
        Log& log = i == 0 ? job.log : later.begin();
        job.request.outputs = frames[i].outputs;
        Result<ChosenCamera> camera = prepare(job, frames[i], turn, log);
        if (!camera) return fail(camera.error());
        const Result<void> done = render_and_write(job, *camera, turn, log, progress);
        if (!done) return done;
        if (job.asset) job.asset->take_back(job.prepared->take_scene());
        later.end();
        if (!frames[i].number) continue;
        job.statistics.frames.push_back(frame_statistics(frames[i], before, job.statistics));
        job.log.info(fmt::format("frame {} of {} to {} is written",
                                 *frames[i].number,
                                 job.request.frames->first,
                                 job.request.frames->last));
    }
    progress.finish();
    return {};
}

/// --check: for every picture all that comes before the BVH.
Result<void> check_all(Job& job) {
    if (const Result<void> loaded = load(job); !loaded) return loaded;
    const std::vector<MovieFrame> frames = frames_of(job.request);
    RepeatedLog later(job.log);
    for (size_t i = 0; i < frames.size(); ++i) {
        Log& log = i == 0 ? job.log : later.begin();
        Result<Scene> scene = pose(job, frames[i], {i, frames.size()}, log);
        if (!scene) return fail(scene.error());
        if (frames.size() > 1 && i == 0) job.request.camera.framed = scene->bounds;
        const Result<ChosenCamera> chosen = choose_unfocused_camera(*scene, job.request, log);
        if (!chosen) return fail(chosen.error());
        const Result<void> exposed = expose_display(*chosen, job.request, job.display, log);
        if (!exposed) return exposed;
        job.asset->take_back(std::move(*scene));
        later.end();
    }
    if (!has_isa(job.request.isa)) return fail(missing_isa());
    job.log.info("checked: nothing forbids to render it; nothing was written");
    return {};
}

void log_summary(const RenderRequest& request, const RenderStatistics& statistics, Log& log) {
    std::string names;
    for (const std::filesystem::path& output : request.outputs) {
        names += (names.empty() ? "" : ", ") + output.string();
    }
    const double seconds = std::max(statistics.render_s, 1e-9);
    const auto millions = [&](uint64_t count) {
        return static_cast<double>(count) / seconds * 1e-6;
    };
    const std::string what =
        request.frames ? fmt::format("rendered {} frames", request.frames->count()) : "rendered";
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

Result<void> execute(const RenderRequest& request, Log& log) {
    const Stopwatch total;
    if (auto writable = check_outputs(request); !writable) return writable;
    Result<std::optional<DisplayTransform>> display = make_display(request, log);
    if (!display) return fail(display.error());
    const ThreadLimit threads(request.threads);
    Job job{log, request, std::move(*display), {}, {}, {}, {}, {}, {}, {}};
    RenderStatistics& statistics = job.statistics;
    statistics.threads = threads.threads();
    if (request.check) return check_all(job);
    Progress progress(request.verbosity);
    const Result<void> done = render_all(job, progress);
    if (!done) return done;
    statistics.total_s = total.seconds();
    statistics.warnings = log.warnings();
    if (auto written = write_statistics(request, statistics); !written) return written;
    log_summary(request, statistics, log);
    return check_counters(statistics.counters, request);
}

}  // namespace

int run_render(const RenderArguments& arguments) {
    Log log(verbosity_of(arguments));
    Result<RenderRequest> request = make_render_request(arguments);
    if (!request) return report_failure(request.error(), log);
    const Result<void> loaded = load_requested_camera(*request, log);
    if (!loaded) return report_failure(loaded.error(), log);
    const Result<void> done = execute(*request, log);
    if (done) return report_success(request->scene.string(), log);
    if (done.error().id == "E-STOPPED" && received_stop_signal() != 0) {
        return report_stop(received_stop_signal(), request->scene.string(), log);
    }
    return report_failure(done.error(), log);
}

}  // namespace obscura
