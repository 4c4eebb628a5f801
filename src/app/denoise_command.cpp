// app/denoise_command.cpp - the subcommand `obscura denoise`: read, denoise, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/denoise_command.h"

#include "app/memory_option.h"
#include "app/outcome.h"
#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "base/parallel.h"
#include "session/denoised_file.h"
#include "session/outputs.h"

#include <atomic>

namespace obscura::app {

namespace {

Result<ExrDocument> open(const std::filesystem::path& file) {
    FileBytes read = read_file_bytes(file, {});
    if (read.fault != FileFault::none) {
        return fail(ExitCode::missing_scene, "E-EXR-MISSING", file.string(), read.reason);
    }
    return ExrDocument::read(std::move(read.bytes), file.string());
}

/// Writes the images for displays.
Result<void> write_displays(RenderRequest request, const DenoisedFile& denoised, Log& log) {
    if (request.outputs.empty()) return {};
    const OutputImage& image = denoised.finished.image;
    request.options.width = image.part_of->width;
    request.options.height = image.part_of->height;
    if (request.color_space.empty()) request.color_space = denoised.space;
    if (request.color_space.empty()) {
        log.warn(request.scene.string(),
                 "its header names no known space; its colours are taken as lin_rec709 "
                 "(--color-space tells another)");
    }
    if (auto used = use_color_space(request, log); !used) return used;
    const Result<ImageList> list = list_images(request, {});
    if (!list) return fail(list.error());
    if (auto fits = check_image_files(request, list->images); !fits) return fits;
    Result<std::optional<DisplayTransform>> display = make_display(request, log);
    if (!display) return fail(display.error());
    ChosenCamera camera;
    camera.ev100 = denoised.ev100;
    if (auto done = expose_display(camera, request, *display, log); !done) return done;
    FinishedImage finished = denoised.finished;
    finished.metadata.space = request.space;
    return write_outputs(request, finished, *display, std::atomic<bool>(false), log);
}

Result<void> execute(const DenoiseRequest& request, Log& log) {
    const ThreadLimit threads(request.render.threads);
    if (auto begun = start_threads_ahead(); !begun) return begun;
    if (auto there = check_writers(request.render); !there) return there;
    const Result<ExrDocument> document = open(request.file);
    if (!document) return fail(document.error());
    const Result<DenoisedFile> denoised = denoise_document(*document, request.keep_noisy, log);
    if (!denoised) return fail(denoised.error());
    if (auto done = write_displays(request.render, *denoised, log); !done) return done;
    for (const std::filesystem::path& file : request.exrs) {
        if (auto done = write_file_atomically(file, denoised->exr.bytes); !done) return done;
        warn_of(denoised->exr.report, file.string(), log);
    }
    log.info("denoised: " + denoised->done);
    return {};
}

}  // namespace

int run_denoise(const DenoiseArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    const Result<DenoiseRequest> request = make_denoise_request(arguments);
    if (!request) return report_failure(request.error(), log);
    const Result<void> done = execute(*request, log);
    return done ? report_success(request->file.string(), log) : report_failure(done.error(), log);
}

}  // namespace obscura::app
