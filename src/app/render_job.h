// app/render_job.h - one run of `obscura render`, and how an image of it is made and written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/display_server.h"
#include "app/kept_assets.h"
#include "app/progress.h"
#include "app/watch.h"
#include "render/environment_cache.h"
#include "session/asset_renderer.h"
#include "session/image_parts.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace obscura::app {

/// What the renderings of a job have in common, and leave for each other.
struct KeptForLater {
    KeptAssets assets = {};
    /// Facts of their files, by the scene.
    std::map<std::filesystem::path, NamedTexts> asset_facts = {};
    FileChecksums checksums = {};  ///< of other files
    struct Environment {
        std::shared_ptr<const ImageRgb32f> image;
        Notes notes;  ///< what reading it had to say
    };
    /// Those that later renderings need, too, by environment_key, and their tables.
    std::map<std::string, Environment> environments = {};
    std::shared_ptr<EnvironmentCache> environment_tables = std::make_shared<EnvironmentCache>();
    /// Begins to read the asset of the next rendering; an empty one: nothing is read ahead.
    std::function<void(int threads)> read_ahead = {};
    size_t run = 0;  ///< the rendering, by its number
    /// Files of all renderings so far, by the first one that writes them; SIZE_MAX: it is read.
    std::map<std::filesystem::path, size_t> written = {};
    bool has_manifest = false;  ///< the rendering tells the manifest of its failures itself
    std::unique_ptr<DisplayServer> viewer = {};  ///< who is shown all images; null: nobody
};

/// What a data set does beside each image; empty ones: nothing.
struct ImageHooks {
    /// Chooses the camera of the posed and prepared image anew.
    std::function<Result<ChosenCamera>(
        AssetRenderer& renderer, RenderRequest& request, const ChosenCamera& camera, Log& log)>
        aim = {};
    /// Writes what belongs to an image whose colours are finished, before these are written.
    std::function<Result<void>(const RenderRequest& request,
                               const PreparedScene& prepared,
                               const ChosenCamera& camera,
                               const std::atomic<bool>& stop,
                               Log& log)>
        label = {};
    /// With --skip-existing: whether that is there.
    std::function<bool(const ListedImage& image)> has_label = {};
};

/// Runs one command, from the request to the statistics.
struct Job {
    Log& log;                    ///< the command's; frames may have their own
    const RenderRequest& whole;  ///< what the whole command is asked for
    RenderRequest request;       ///< of the image that is being made
    NamedTexts options;          ///< as they were given, for --part, --checkpoint, fingerprints
    const ImageParts* parts = nullptr;  ///< where pixels come from; null: they are rendered
    Watch& watch;
    KeptForLater& kept;
    ImageHooks hooks = {};
    std::optional<DisplayTransform> display = {};
    bool is_exposed = false;  ///< the display, by a camera's own exposure
    std::optional<AssetRenderer> renderer = {};
    int threads = 1;  ///< that it renders with
    LightingOptions lighting = {};
    Notes asset_notes = {};       ///< what opening the asset and its first pose had to say
    NamedTexts facts = {};        ///< that pixels depend on; files are read for them before loading
    NamedTexts image_facts = {};  ///< those of ListedImage, of the image that is being made
    bool has_begun = false;       ///< the first image is being rendered
    size_t rendered = 0;
    size_t skipped = 0;         ///< images that were there, with --skip-existing
    bool leaves_files = false;  ///< make_image leaves a finished image in `unwritten`
    std::optional<FinishedImage> unwritten = {};
};

/// Where a command stands with its images.
struct Turn {
    size_t done;    ///< images before this one
    size_t count;   ///< of all that are to be there in the end
    bool is_first;  ///< of the sequence
    bool is_last;   ///< none follows
};

/// Makes the display that of an image: a camera may bring an exposure of its own.
///
/// Errors  78 E-OCIO-*
Result<void> expose(Job& job, const ChosenCamera& camera, Log& log);

/// Renders the posed and prepared image, or takes its pixels from parts, and writes its files, or
/// leaves that to the caller; with --part the part's file. Keeps a checkpoint and writes snapshots
/// meanwhile, if asked to.
///
/// Errors  those of rendering and writing; 75 E-STOPPED a signal came: the message says what was
///         kept; 75 E-TIME-LIMIT; those of FilmKeeper::find
Result<void> make_image(
    Job& job, const ChosenCamera& camera, const Turn& turn, Log& log, Progress& progress);

/// Renders the images of the request in turn: those of its part, and with --skip-existing those
/// that are neither there nor of others.
///
/// With lists of images (ListRequest::is_asked) one that fails does not end the rest, unless the
/// program is to stop: its error comes in the end.
///
/// Errors  those of loading, posing and make_image; 75 E-LOCKED images are left to others
Result<void> render_all(Job& job, Progress& progress);

/// Notes the names of all files that rendering would write, as if an earlier rendering of the
/// command wrote them.
///
/// Errors  those of opening the asset; 64 E-USAGE-SAMEFILE
Result<void> note_all_files(Job& job);

/// --dry-run: prints the names of all files that rendering would write.
Result<void> list_all(Job& job);

/// --check: for every image, all steps before the BVH.
Result<void> check_all(Job& job);

}  // namespace obscura::app
