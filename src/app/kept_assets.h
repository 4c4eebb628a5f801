// app/kept_assets.h - assets that are open for later renderings of a job, or are read ahead.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/noted_log.h"
#include "film/state_bytes.h"
#include "session/asset_renderer.h"
#include "session/render_request.h"

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura::app {

/// How an asset is opened: renderings of one use can share it.
struct AssetUse {
    std::filesystem::path scene = {};
    gltf::LoadOptions load = {};
    bool has_times = false;  ///< it will be posed at times
    Isa isa = Isa::automatic;

    bool operator==(const AssetUse&) const = default;
};

/// In      request: its files are read (read_named_files)
AssetUse asset_use(const RenderRequest& request);

/// Time and variant in which an asset stands.
struct AssetPose {
    PoseTimes times = {};  ///< without `is_last`
    std::string variant = {};

    bool operator==(const AssetPose&) const = default;
};

/// In      request: for the shutter
AssetPose pose_at(const RenderRequest& request, double time_s, const std::string& variant);
/// The time of a sequence's first image, or of all images.
double first_time_s(const RenderRequest& request);

/// An asset that is open, and what is known of it.
struct KeptAsset {
    AssetRenderer renderer;
    NamedTexts facts = {};               ///< those of facts_of_asset; empty: not known yet
    Notes notes = {};                    ///< what opening it and its first pose had to say
    std::optional<AssetPose> pose = {};  ///< that it was read ahead for, and not yet prepared in
};

/// Tells an asset which variants a request shows.
///
/// Errors  those of variants_to_plan and AssetRenderer::plan_variants
Result<void> plan_variants(const RenderRequest& request, AssetRenderer& renderer);

/// Opens the asset of a request, with such a plan.
///
/// Errors  those of AssetRenderer::open and plan_variants
Result<AssetRenderer> open_asset(const RenderRequest& request, Log& log);

/// Where more of the memory budget is taken, no further asset is opened beside those that wait.
inline constexpr double max_share_of_kept = 0.5;

/// Keeps assets open. Used by one thread at a time; it reads ahead in a thread of its own.
class KeptAssets {
public:
    /// What is open, or being read, for this use; from then on it is the caller's. Nothing: there
    /// is none.
    std::optional<KeptAsset> take(const AssetUse& use);

    void keep(AssetUse use, KeptAsset asset);

    /// Begins to read the asset of a request and to pose it for its first image, beside whatever
    /// goes on; unless the scene is open or another one is being read. What fails is forgotten:
    /// who asks for the asset reads it again, and says why.
    ///
    /// In      request: its files need not be read; threads: that it may use
    void read_ahead(RenderRequest request, int threads);

    /// Whether a thread is reading, which nothing can stop but the end of the program.
    bool is_reading() const;

    /// Closes all, and waits for what is being read. False: there was nothing.
    bool close_all();

    /// Closes what no later rendering needs, and waits for it where it is being read.
    ///
    /// In      is_needed: says so of a scene
    template <typename Needed>
    void close_unless(const Needed& is_needed) {
        if (reading_.valid() && !is_needed(scene_being_read_)) finish_reading();
        std::erase_if(open_, [&](const auto& entry) { return !is_needed(entry.first.scene); });
    }

private:
    using Entry = std::pair<AssetUse, KeptAsset>;

    void finish_reading();

    std::vector<Entry> open_;
    std::filesystem::path scene_being_read_;
    std::future<std::optional<Entry>> reading_;
};

}  // namespace obscura::app
