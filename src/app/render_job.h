// app/render_job.h - one run of `obscura render`, and how an image of it is made and written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/progress.h"
#include "app/watch.h"
#include "session/asset_renderer.h"
#include "session/image_parts.h"

#include <cstddef>
#include <optional>

namespace obscura::app {

/// Runs one command, from the request to the statistics.
struct Job {
    Log& log;               ///< the command's; frames may have their own
    RenderRequest request;  ///< its outputs, frame and what its camera keeps change by frame
    NamedTexts options;     ///< as they were given, for --part and --checkpoint
    const ImageParts* parts = nullptr;  ///< where pixels come from; null: they are rendered
    Watch& watch;
    std::optional<DisplayTransform> display = {};
    std::optional<AssetRenderer> renderer = {};
    LightingOptions lighting = {};
    std::optional<NamedTexts> facts = {};  ///< that pixels depend on, once they are known
    bool has_begun = false;                ///< the first image is being rendered
};

/// An image's index and their number.
struct Turn {
    size_t index;
    size_t count;
    bool is_last() const { return index + 1 == count; }
};

/// Renders the posed and prepared image, or takes its pixels from parts, and writes its files; with
/// --part the part's file. Keeps a checkpoint and writes snapshots meanwhile, if asked to.
///
/// Errors  those of rendering and writing; 75 E-STOPPED a signal came: the message says what was
///         kept; 75 E-TIME-LIMIT; those of FilmKeeper::find
Result<void> make_image(
    Job& job, const ChosenCamera& camera, const Turn& turn, Log& log, Progress& progress);

}  // namespace obscura::app
