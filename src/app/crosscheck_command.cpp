// app/crosscheck_command.cpp - the subcommand `obscura crosscheck`: check, print, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/crosscheck_command.h"

#include "app/memory_option.h"
#include "app/outcome.h"
#include "app/skipped_scenes.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "crosscheck/budget.h"
#include "crosscheck/report_image.h"
#include "crosscheck/report_json.h"
#include "crosscheck/report_table.h"

#include <span>

namespace obscura::app {

namespace {

Result<void> check_files(const CrosscheckRequest& request) {
    if (request.json) {
        if (auto writable = check_file_can_be_written(*request.json); !writable) return writable;
    }
    if (request.image) {
        if (auto writable = check_output(*request.image); !writable) return fail(writable.error());
    }
    if (!has_isa(request.scenes.front().isa)) return fail(missing_isa());
    return {};
}

/// A loaded scene and its camera.
struct Loaded {
    Scene scene;
    crosscheck::CheckTask task;
};

Result<void> load(const RenderRequest& request,
                  const CrosscheckRequest& all,
                  Log& log,
                  Loaded& out) {
    Result<Scene> scene = gltf::load_gltf(request.scene, request.load, log);
    if (!scene) return fail(scene.error());
    out.scene = std::move(*scene);
    const RenderOptions& options = request.options;
    const Result<ChosenCamera> camera =
        choose_camera(out.scene, request.camera, options.width, options.height, log);
    if (!camera) return fail(camera.error());
    out.task.scene = &out.scene;
    out.task.name = request.scene.stem().string();
    out.task.file = request.scene.string();
    out.task.rays = {camera->camera, options.width, options.height, all.rays, options.seed};
    out.task.export_embree = all.export_embree;
    out.task.isa = request.isa;
    return {};
}

Result<void> deliver(const CrosscheckRequest& request,
                     const std::vector<crosscheck::CheckedScene>& scenes,
                     const Log& log) {
    if (request.json) {
        const std::string text = crosscheck::crosscheck_json(scenes, log.warnings());
        const auto written = write_file_atomically(*request.json, std::as_bytes(std::span(text)));
        if (!written) return written;
    }
    if (request.image) {
        ImageMetadata metadata;
        metadata.software = "Obscura " OBSCURA_VERSION;
        metadata.asset = request.scenes.front().scene.filename().string();
        metadata.is_color = false;
        const auto written = write_image_file(*request.image,
                                              crosscheck::screen_image(scenes.front().screen),
                                              metadata,
                                              {.depth = ExrDepth::float32},
                                              DisplayEncoding{});
        if (!written) return fail(written.error());
    }
    return crosscheck::check_budget(scenes);
}

Result<void> execute(const CrosscheckRequest& request, Log& log) {
    if (auto sound = check_files(request); !sound) return sound;
    const ThreadLimit threads(request.scenes.front().threads);
    if (auto begun = start_threads_ahead(); !begun) return begun;
    std::vector<crosscheck::CheckedScene> checked;
    SkippedScenes skipped(request.scenes.size(), log);
    for (const RenderRequest& scene : request.scenes) {
        log.info("checking " + scene.scene.string());
        Loaded loaded;
        if (auto done = load(scene, request, log, loaded); !done) {
            if (skipped.skip(done.error())) continue;
            return done;
        }
        if (request.ray) {
            const Result<std::string> lines =
                crosscheck::replay_ray(loaded.scene, *request.ray, scene.isa);
            if (!lines) return fail(lines.error());
            return print_output(*lines);
        }
        Result<crosscheck::CheckedScene> one = crosscheck::check_scene(loaded.task, log);
        if (!one) return fail(one.error());
        if (auto printed = print_output(crosscheck::check_table(*one)); !printed) return printed;
        checked.push_back(std::move(*one));
    }
    if (auto delivered = deliver(request, checked, log); !delivered) return delivered;
    return skipped.result();
}

}  // namespace

int run_crosscheck(const CrosscheckArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    const Result<CrosscheckRequest> request = make_crosscheck_request(arguments);
    if (!request) return report_failure(request.error(), log);
    const Result<void> done = execute(*request, log);
    return done ? report_success("crosscheck", log) : report_failure(done.error(), log);
}

}  // namespace obscura::app
