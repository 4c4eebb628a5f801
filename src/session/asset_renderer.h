// session/asset_renderer.h - an asset that is read once and of which images are made.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/load.h"
#include "render/render.h"

#include "session/outputs.h"
#include "session/render_request.h"
#include "session/statistics.h"
#include <filesystem>
#include <optional>

namespace obscura {

/// When an asset is looked at.
struct PoseTimes {
    double time_s = 0;
    std::optional<ShutterTimes> shutter = {};  ///< open around that time
    bool is_last = false;  ///< no other pose will be asked for: memory is given back sooner
};

/// Who wants to know how a rendering goes on, and may stop it.
struct RenderHooks {
    ProgressFunction progress;
    const std::atomic<bool>* stop = nullptr;  ///< null: nobody stops it
};

/// From an asset to images, one after the other: what one leaves, the next uses. Used by one thread
/// at a time.
class AssetRenderer {
public:
    /// Reads the asset; its images are decoded with the first pose.
    ///
    /// In      has_time: poses at times will be asked for, see PosedAsset
    /// Errors  those of load_gltf
    static Result<AssetRenderer> open(const std::filesystem::path& file,
                                      const LoadOptions& options,
                                      bool has_time,
                                      Log& log);

    /// The scene at a time, in place of the one before.
    ///
    /// Errors  those of load_gltf
    Result<void> pose(const PoseTimes& times, Log& log);

    /// As it was posed; after prepare(), with points and lines as thick as the request says.
    const Scene& scene() const;
    const Degraded& degraded() const { return degraded_; }

    /// True while there is a posed or prepared scene; false after a fault on the way.
    bool has_scene() const { return scene_ || is_prepared_; }

    /// Gives up what was built, but for what was read: for another light or instruction set.
    void start_anew();

    /// Chooses the camera and builds what rendering reads and the image before has not left. Once
    /// for each pose.
    ///
    /// Errors  those of choose_unfocused_camera, focus and PreparedScene::create
    Result<ChosenCamera> prepare(const RenderRequest& request,
                                 const LightingOptions& lighting,
                                 Log& log);

    /// Chooses another camera for the prepared pose; points and lines stay as thick as they are.
    ///
    /// Errors  those of choose_unfocused_camera and focus
    Result<ChosenCamera> look_again(const RenderRequest& request, Log& log) const;

    /// Renders the prepared pose.
    ///
    /// In      log: whose number of warnings the image's header tells
    /// Errors  those of render
    Result<FinishedPicture> render(const RenderRequest& request,
                                   const ChosenCamera& camera,
                                   const RenderHooks& hooks,
                                   const Log& log);

    /// Memory of an image that is no longer needed, for the next one.
    void recycle(Picture&& picture) { film_memory_ = std::move(picture.pixels); }

    /// Sums over all images so far.
    RenderStatistics& statistics() { return statistics_; }

private:
    explicit AssetRenderer(PosedAsset asset) : asset_(std::move(asset)) {}

    std::optional<PosedAsset> asset_;        ///< until the last pose
    std::optional<Scene> scene_;             ///< posed, not yet prepared
    std::optional<PreparedScene> prepared_;  ///< of the latest image
    bool is_prepared_ = false;               ///< `prepared_` is of the latest pose
    Degraded degraded_;                      ///< what the latest scene lacks
    UnsetArray<float> film_memory_;
    RenderStatistics statistics_;
};

}  // namespace obscura
