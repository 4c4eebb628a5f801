// app/long_run_options.cpp - the options for renderings that take hours and may be cut short.
// SPDX-License-Identifier: Apache-2.0
#include "app/long_run_options.h"

#include "app/frames.h"
#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/render_request.h"
#include "session/fingerprint.h"
#include "session/image_names.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using G = LongRunArguments;
using K = LongRun;
using R = RenderRequest;

constexpr std::array<Choice<Resume>, 3> resumes = {
    {{"auto", Resume::automatic}, {"require", Resume::require}, {"never", Resume::never}}};

/// Without a value the text is "true", as in a file of --config.
constexpr OptionReader<R> checkpoint = {
    .read = [](const OptionInfo& info, const std::string& text, R& r) -> Result<void> {
        r.long_run.has_checkpoint = text != "false";
        if (text == "true" || text == "false") return {};
        const Result<std::string> name = parse_name(text, long_name(info));
        if (!name) return fail(name.error());
        r.long_run.checkpoint = *name;
        return {};
    }};

// clang-format off
constexpr OptionEntry<A, R> entries[] = {
    {{.name = "--checkpoint", .argument = "[=FILE]",
      .help = "Keep what is finished in a file, and carry on from it when the same command is run "
              "again; with --frames, FILE has # for the number. Removed when the picture is "
              "written, but for --keep-checkpoint",
      .fallback = "none; without FILE, OUTPUT.checkpoint"},
     text_at<&A::long_run, &G::checkpoint>, checkpoint},
    {{.name = "--checkpoint-interval", .argument = "SECONDS",
      .help = "Time between checkpoints; the first one is written after 30 s, or after this time "
              "if that is shorter",
      .range = {0.05, 1e6}, .needs = {"--checkpoint"}},
     text_at<&A::long_run, &G::interval>,
     number_at<&R::long_run, &K::checkpoint_interval_s>},
    {{.name = "--keep-checkpoint",
      .help = "Leave the checkpoint when the picture is written: the same command with a higher "
              "--spp goes on from it",
      .needs = {"--checkpoint"}},
     text_at<&A::long_run, &G::keep_checkpoint>, flag_at<&R::long_run, &K::keep_checkpoint>},
    {{.name = "--resume", .argument = "NAME",
      .help = "Carry on from a checkpoint: where there is one, only if there is one, or start "
              "anew:", .needs = {"--checkpoint"}},
     text_at<&A::long_run, &G::resume>, choice_at<resumes, &R::long_run, &K::resume>},
    {{.name = "--time-limit", .argument = "SECONDS",
      .help = "Stop after this time with the picture of the samples so far, marked in the header, "
              "a checkpoint if one is kept, and exit code 75",
      .range = {0.05, 1e8}, .fallback = "none"},
     text_at<&A::long_run, &G::time_limit>, number_at<&R::long_run, &K::time_limit_s>},
    {{.name = "--snapshot", .argument = "SECONDS",
      .help = "Write the picture so far to the outputs again and again while rendering, each file "
              "whole or not at all, without denoising",
      .range = {0.05, 1e6}, .fallback = "none"},
     text_at<&A::long_run, &G::snapshot>, number_at<&R::long_run, &K::snapshot_interval_s>},
    {{.name = "--skip-existing",
      .help = "Leave images, and frames of a sequence, as they are whose files are all there and "
              "were rendered by the same options from the same bytes, as a fingerprint in their "
              "headers tells. A lock beside the first output lets several machines share a "
              "sequence"},
     text_at<&A::long_run, &G::skip_existing>, flag_at<&R::long_run, &K::skips_existing>}};
// clang-format on

}  // namespace

Result<void> complete_long_run(RenderRequest& request) {
    if (auto fits = check_skips_existing(request); !fits) return fits;
    LongRun& run = request.long_run;
    if (run.snapshot_interval_s && request.outputs.empty())
        return conflict("--snapshot", "give -o a file's name, which the picture so far gets");
    if (run.snapshot_interval_s && is_part_of_image(request))
        return conflict("--snapshot", "a part of a picture is no picture; leave out one of them");
    if (!run.has_checkpoint) return {};
    if (run.checkpoint.empty() && request.outputs.empty()) {
        return conflict("--checkpoint",
                        "with -o - there is no output to put it beside; give --checkpoint=FILE");
    }
    const bool is_one = !request.frames && !request.lists.is_asked();
    const bool is_numbered = !request.lists.is_asked() || request.lists.turntable > 0;
    const bool has_number = is_numbered && frame_file(run.checkpoint, 0);
    if (is_one || run.checkpoint.empty() || has_number || has_fields(run.checkpoint)) return {};
    return conflict("--checkpoint",
                    "every image has one of its own: FILE must hold # or {frame} for a sequence's "
                    "number, {view} and {variant} for those");
}

OptionGroup<RenderArguments, RenderRequest> long_run_group() {
    return {"Long renderings", entries};
}

}  // namespace obscura::app
