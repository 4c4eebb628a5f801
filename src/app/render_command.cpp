// app/render_command.cpp - the subcommand `obscura render`: load, prepare, render, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_command.h"

#include "app/autofocus.h"
#include "app/lighting.h"
#include "app/outcome.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/signals.h"
#include "app/statistics.h"
#include "app/stroke_scaling.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "gltf/camera_json.h"
#include "gltf/load.h"
#include "scene/scene_memory.h"

#include <fmt/format.h>
#include <span>

namespace obscura {

namespace {

/// Loads and builds everything that rendering reads.
Result<PreparedScene> prepare(const RenderRequest& request,
                              Log& log,
                              RenderStatistics& statistics) {
    const Stopwatch loading;
    Result<Scene> scene = load_gltf(request.scene, request.load, log);
    if (!scene) return fail(scene.error());
    const Result<void> scaled = scale_strokes(request, *scene);
    if (!scaled) return fail(scaled.error());
    Result<LightingOptions> lighting = load_lighting(request, log);
    if (!lighting) return fail(lighting.error());
    statistics.load_s = loading.seconds();
    statistics.parse_s = scene->info.parse_seconds;
    statistics.decode_s = scene->info.decode_seconds;
    statistics.geometry_bytes = geometry_bytes(*scene);
    statistics.texture_bytes = texture_bytes(*scene);

    Result<PreparedScene> prepared =
        PreparedScene::create(std::move(*scene), *lighting, request.isa, log);
    if (!prepared) return prepared;
    statistics.build_s = prepared->build_seconds().all;
    statistics.bvh_bytes = prepared->bvh_bytes();
    statistics.isa = prepared->isa_name();
    statistics.embree = prepared->embree_version();
    return prepared;
}

/// Reads --camera-json; without --size its picture has the size that the file names.
Result<void> load_requested_camera(RenderRequest& request, Log& log) {
    if (!request.camera_json) return {};
    Result<SceneCamera> camera = load_camera_json(*request.camera_json, log);
    if (!camera) return fail(camera.error());
    const Intrinsics& intrinsics = *camera->settings.intrinsics;
    if (!request.size_is_given) {
        request.options.width = static_cast<int>(intrinsics.width_px);
        request.options.height = static_cast<int>(intrinsics.height_px);
    }
    request.camera.loaded = std::move(*camera);
    return check_crop(request.options);
}

/// One rendering from the request to the statistics.
struct Job {
    const RenderRequest& request;
    std::optional<DisplayTransform> display;
    RenderStatistics statistics;
};

/// Renders, then writes the pictures; a signal stops it between two tiles or two files.
Result<void> render_and_write(Job& job,
                              const PreparedScene& prepared,
                              Log& log,
                              Progress& progress) {
    const RenderRequest& request = job.request;
    RenderStatistics& statistics = job.statistics;
    const RenderOptions& options = request.options;
    const Result<ChosenCamera> chosen = choose_focused_camera(prepared, request, log);
    if (!chosen) return fail(chosen.error());
    if (const Result<void> exposed = expose_display(*chosen, request, job.display, log); !exposed) {
        return exposed;
    }

    const StopOnSignal stop;
    progress.begin();
    const auto on_progress = [&](double share) { progress.update(share); };
    Result<RenderResult> result =
        render(prepared, chosen->camera, options, on_progress, stop.flag());
    if (!result) return fail(result.error());
    statistics.render_s = result->render_seconds;
    statistics.counters = result->counters;
    statistics.film_bytes = result->film.pixels.size() * sizeof(float);

    const Stopwatch writing;
    FinishedPicture finished;
    finished.metadata = make_metadata(request, prepared, *chosen, result->render_seconds, log);
    Film& film = result->film;
    finished.picture = {film.width, film.height, std::move(film.channels), std::move(film.pixels)};
    const Result<void> written = write_outputs(request, finished, job.display, stop.flag());
    statistics.write_s = writing.seconds();
    if (!written) return written;
    progress.finish();
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
    log.info(fmt::format("rendered in {:.2f} s: {:.2f} M paths/s, {:.2f} M rays/s; wrote {}",
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
    Job job{request, std::move(*display), {}};
    RenderStatistics& statistics = job.statistics;
    statistics.threads = threads.threads();
    Progress progress(request.verbosity);
    const Result<PreparedScene> prepared = prepare(request, log, statistics);
    if (!prepared) return fail(prepared.error());
    const Result<void> done = render_and_write(job, *prepared, log, progress);
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
