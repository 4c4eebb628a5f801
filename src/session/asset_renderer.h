// session/asset_renderer.h - reads an asset once and makes images of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/load.h"
#include "render/render.h"
#include "session/framed_geometry.h"
#include "session/memory_charges.h"
#include "session/outputs.h"
#include "session/render_request.h"
#include "session/statistics.h"

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace obscura {

/// The time, or shutter interval, of a pose.
struct PoseTimes {
    double time_s = 0;
    std::optional<gltf::ShutterTimes> shutter = {};  ///< open around that time
    bool is_last = false;  ///< no other pose will be asked for: memory is given back sooner

    bool operator==(const PoseTimes&) const = default;
};

/// Callbacks that follow a rendering, and may stop it.
struct RenderHooks {
    ProgressFunction progress;
    const std::atomic<bool>* stop = nullptr;  ///< null: nobody stops it
    const FilmShare* share = nullptr;         ///< null: all rows are rendered
};

/// A film as it is before denoising, with the options that it was rendered with.
struct RenderedFilm {
    RenderOptions options;
    RenderResult result;
};

/// Makes images of an asset, one after the other; each reuses what the previous one built. Used by
/// one thread at a time.
class AssetRenderer {
public:
    /// Reads the asset; images are decoded with the first pose.
    ///
    /// In      has_time: poses at times will be asked for, see PosedAsset
    /// Errors  those of load_gltf
    static Result<AssetRenderer> open(const std::filesystem::path& file,
                                      const gltf::LoadOptions& options,
                                      bool has_time,
                                      Log& log);

    /// Finds the nodes of CameraRequest::framed_node; to be called before the last pose.
    ///
    /// Errors  64 E-NODE-UNKNOWN
    Result<void> find_framed_nodes(CameraRequest& camera) const;

    /// All files of the asset: see gltf/asset_files.h.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    /// What all poses have in common.
    const AssetInfo& info() const { return asset_->info(); }

    /// Tells which variants will be shown; see PosedAsset. choose_variant counts from the next pose
    /// on.
    ///
    /// Errors  64 E-VARIANT-UNKNOWN
    Result<void> plan_variants(const std::vector<std::string>& names, bool several) {
        return asset_->plan_variants(names, several);
    }
    Result<void> choose_variant(const std::string& name) { return asset_->choose_variant(name); }

    /// Sets a property from the next pose on; see PosedAsset.
    ///
    /// Errors  64 E-SET-UNKNOWN, E-SET-VALUE
    Result<void> set_value(const std::string& pointer, const std::vector<double>& value) {
        return asset_->set_value(pointer, value);
    }

    /// Gives a node a material from the next pose on; see PosedAsset.
    ///
    /// Errors  64 E-SET-UNKNOWN
    Result<void> assign_material(size_t node, size_t material) {
        return asset_->assign_material(node, material);
    }

    /// Poses the scene at a time; this replaces the previous pose.
    ///
    /// Errors  those of load_gltf
    Result<void> pose(const PoseTimes& times, Log& log);

    /// Gives memory back: no other pose than the present one will be asked for.
    void forget_asset() { asset_.reset(); }
    /// False after the last pose.
    bool can_pose() const { return asset_.has_value(); }

    /// The posed scene; after prepare(), points and lines are as thick as the request says.
    const Scene& scene() const;
    const gltf::Degraded& degraded() const { return degraded_; }

    /// What the latest image was rendered of.
    const PreparedScene& prepared() const { return *prepared_; }

    /// True while there is a posed or prepared scene; false after an error.
    bool has_scene() const { return scene_ || is_prepared_; }

    /// Makes the prepared pose ready for prepare() once more, for another light; what is built and
    /// still fits is kept.
    void prepare_again();

    /// Drops what was built, but not what was read: for another light or instruction set.
    void start_anew();

    /// Chooses the camera and builds what rendering needs, except for parts that the previous image
    /// left and that still fit. To be called once for each pose.
    ///
    /// Errors  those of choose_unfocused_camera, focus and PreparedScene::create
    Result<ChosenCamera> prepare(const RenderRequest& request,
                                 const LightingOptions& lighting,
                                 Log& log);

    /// Chooses another camera for the prepared pose; points and lines stay as thick as they are.
    ///
    /// Errors  those of choose_unfocused_camera and focus
    Result<ChosenCamera> look_again(const RenderRequest& request, Log& log);

    /// For views of the present pose that are chosen elsewhere.
    FramedScene framed_scene() { return {scene(), &geometry_}; }

    /// Renders the prepared pose.
    ///
    /// In      log: its number of warnings goes into the image's header
    /// Errors  those of render and choose_frame_cameras
    Result<FinishedImage> render(const RenderRequest& request,
                                 const ChosenCamera& camera,
                                 const RenderHooks& hooks,
                                 const Log& log);

    /// The two halves of render(): the film, and what is made of a whole one.
    Result<RenderedFilm> render_film(const RenderRequest& request,
                                     const ChosenCamera& camera,
                                     const RenderHooks& hooks);
    FinishedImage finish(const RenderRequest& request,
                         const ChosenCamera& camera,
                         RenderedFilm&& rendered,
                         const Log& log);

    /// What the latest image has taken from the memory budget, for who keeps it while another one
    /// is rendered.
    MemoryCharge take_film_charge() { return std::exchange(charges_.film, {}); }

    /// Memory of an image that is no longer needed, for the next one.
    void recycle(OutputImage&& image) { film_memory_ = std::move(image.pixels); }

    /// Sums over all images so far.
    RenderStatistics& statistics() { return statistics_; }

private:
    explicit AssetRenderer(gltf::PosedAsset asset)
        : files_(asset.files()), asset_(std::move(asset)) {}

    /// The request's options, with what the prepared pose and the camera add.
    ///
    /// Errors  those of choose_frame_cameras
    Result<RenderOptions> options_of_image(const RenderRequest& request,
                                           const ChosenCamera& camera);

    std::vector<std::filesystem::path> files_;
    std::optional<gltf::PosedAsset> asset_;  ///< until the last pose
    std::optional<Scene> scene_;             ///< posed, not yet prepared
    std::optional<PreparedScene> prepared_;  ///< of the latest image
    bool is_prepared_ = false;               ///< `prepared_` is of the latest pose
    KeptGeometry geometry_;                  ///< of the latest pose
    gltf::Degraded degraded_;                ///< what the latest scene lacks
    UnsetArray<float> film_memory_;
    RenderStatistics statistics_;
    MemoryCharges charges_;
};

}  // namespace obscura
