// app/denoise_command.cpp - the subcommand `obscura denoise`: read, denoise, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/denoise_command.h"

#include "app/memory_option.h"
#include "app/outcome.h"
#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "base/parallel.h"
#include "session/denoised_file.h"
#include "session/image_names.h"
#include "session/outputs.h"

#include <atomic>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string>
#include <vector>

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

/// Writes what became of one file.
Result<void> write_denoised(const DenoiseRequest& request, const DenoisedFile& denoised, Log& log) {
    if (auto done = write_displays(request.render, denoised, log); !done) return done;
    for (const std::filesystem::path& file : request.exrs) {
        if (auto done = write_file_atomically(file, denoised.exr.bytes); !done) return done;
        warn_of(denoised.exr.report, file.string(), log);
    }
    return {};
}

/// The request for one frame of a sequence.
DenoiseRequest request_of_frame(const DenoiseRequest& sequence, int frame) {
    DenoiseRequest out = sequence;
    out.file = numbered_file(sequence.file, frame);
    out.render.scene = out.file;
    out.render.frames.reset();
    for (std::filesystem::path& file : out.exrs)
        file = numbered_file(file, frame);
    for (std::filesystem::path& file : out.render.outputs)
        file = numbered_file(file, frame);
    return out;
}

/// The files of a sequence that are open.
class OpenFrames {
public:
    explicit OpenFrames(const std::filesystem::path& pattern) : pattern_(pattern) {}

    /// Closes all frames that are further than one away.
    void stay_near(int frame) {
        std::erase_if(documents_, [&](const auto& one) { return std::abs(one.first - frame) > 1; });
    }

    Result<const ExrDocument*> at(int frame) {
        const auto found = documents_.find(frame);
        if (found != documents_.end()) return &found->second;
        Result<ExrDocument> opened = open(numbered_file(pattern_, frame));
        if (!opened) return fail(opened.error());
        return &documents_.emplace(frame, std::move(*opened)).first->second;
    }

    /// Null where there is no such file.
    Result<const ExrDocument*> find(int frame) {
        std::error_code error;
        const bool is_there = frame >= 0 && exists(numbered_file(pattern_, frame), error);
        return is_there ? at(frame) : Result<const ExrDocument*>(nullptr);
    }

private:
    std::filesystem::path pattern_;
    std::map<int, ExrDocument> documents_;
};

/// What would end a sequence in its middle, as far as it can be known before.
Result<void> check_files(const DenoiseRequest& request) {
    std::error_code error;
    for (const int number : request.render.frames->numbers) {
        const DenoiseRequest frame = request_of_frame(request, number);
        if (!exists(frame.file, error)) {
            return fail(ExitCode::missing_scene,
                        "E-EXR-MISSING",
                        frame.file.string(),
                        fmt::format("there is no frame {}; nothing was written", number));
        }
        std::vector<std::filesystem::path> outputs = frame.render.outputs;
        outputs.insert(outputs.end(), frame.exrs.begin(), frame.exrs.end());
        for (const std::filesystem::path& file : outputs) {
            if (auto writable = check_file_can_be_written(file); !writable) return writable;
        }
    }
    return {};
}

/// Tells a sequence's warnings once, whichever frame's file they come from.
class TextsOnce {
public:
    explicit TextsOnce(Log& log)
        : own_(
              log.verbosity(),
              [this, &log](const LogMessage& message) {
                  const bool is_new = told_.emplace(message.text).second;
                  if (message.is_warning && is_new) log.warn(message.where, message.text);
              },
              SettingNames::options) {}

    Log& log() { return own_; }

private:
    std::set<std::string> told_;
    Log own_;
};

/// Every frame with the help of those beside it.
Result<void> denoise_sequence(const DenoiseRequest& request, Log& log) {
    if (auto fit = check_files(request); !fit) return fit;
    OpenFrames frames(request.file);
    TextsOnce once(log);
    const std::vector<int>& numbers = request.render.frames->numbers;
    bool has_neighbor = false;
    for (size_t i = 0; i < numbers.size(); ++i) {
        const int number = numbers[i];
        frames.stay_near(number);
        const Result<const ExrDocument*> document = frames.at(number);
        if (!document) return fail(document.error());
        const Result<const ExrDocument*> before = frames.find(number - 1);
        if (!before) return fail(before.error());
        const Result<const ExrDocument*> after = frames.find(number + 1);
        if (!after) return fail(after.error());
        has_neighbor |= *before != nullptr || *after != nullptr;
        const Result<DenoisedFile> denoised =
            denoise_document(**document, {*before, *after}, request.keep_noisy, once.log());
        if (!denoised) return fail(denoised.error());
        const DenoiseRequest frame = request_of_frame(request, number);
        if (auto done = write_denoised(frame, *denoised, once.log()); !done) return done;
        log.info(fmt::format(
            "frame {} is written, {} of {}: {}", number, i + 1, numbers.size(), denoised->done));
    }
    if (!has_neighbor) log.warn("--frames", "no frame had one beside it; each was denoised alone");
    return {};
}

Result<void> execute(const DenoiseRequest& request, Log& log) {
    const ThreadLimit threads(request.render.threads);
    if (auto begun = start_threads_ahead(); !begun) return begun;
    if (auto there = check_writers(request.render); !there) return there;
    if (request.render.frames) return denoise_sequence(request, log);
    const Result<ExrDocument> document = open(request.file);
    if (!document) return fail(document.error());
    const Result<DenoisedFile> denoised = denoise_document(*document, {}, request.keep_noisy, log);
    if (!denoised) return fail(denoised.error());
    if (auto done = write_denoised(request, *denoised, log); !done) return done;
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
