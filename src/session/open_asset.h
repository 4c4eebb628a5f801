// session/open_asset.h - an asset that stays open: each image changes only what it must.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/asset_renderer.h"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// When an image is; nothing: the asset as it is stored.
struct ImageTime {
    std::optional<double> time_s;
    std::optional<std::array<double, 2>> shutter_s;  ///< opens and closes, from `time_s`

    bool is_given() const { return time_s || shutter_s; }
    bool operator==(const ImageTime&) const = default;
};

/// An asset and what was made of it. The file is read when it is first needed, and again where an
/// image needs what was thrown away. Used by one thread at a time.
class OpenAsset {
public:
    OpenAsset(std::filesystem::path file, gltf::LoadOptions load)
        : file_(std::move(file)), load_(std::move(load)) {}

    /// Reads the file, and poses the scene as it is stored.
    ///
    /// Errors  those of AssetRenderer
    Result<void> open(Log& log);

    /// Brings the asset to an image's pose and light, unless it is there already, and chooses the
    /// camera.
    ///
    /// In      request: its `load` does not count: see `load`
    /// Errors  those of AssetRenderer and load_lighting
    Result<ChosenCamera> prepare(const RenderRequest& request, const ImageTime& time, Log& log);

    /// How the file is read. Another variant is chosen without reading it again.
    const gltf::LoadOptions& load() const { return load_; }
    /// From the next image on; a change of anything but the variant reads the file again.
    ///
    /// Errors  64 E-VARIANT-UNKNOWN; those of AssetRenderer::open
    Result<void> load_as(const gltf::LoadOptions& load, Log& log);
    Result<void> set_variant(const std::string& name, Log& log);

    /// Sets a property from the next image on; see PosedAsset::set_value.
    ///
    /// Errors  64 E-SET-UNKNOWN, E-SET-VALUE; those of AssetRenderer::open
    Result<void> set_value(const std::string& pointer, const std::vector<double>& value, Log& log);
    /// Gives a node a material from the next image on; see PosedAsset::assign_material.
    ///
    /// Errors  64 E-SET-UNKNOWN; those of AssetRenderer::open
    Result<void> assign_material(size_t node, size_t material, Log& log);
    /// Forgets what was set and assigned.
    void reset();

    /// After open() or prepare() without error.
    AssetRenderer& renderer() { return *renderer_; }

private:
    /// Purposes for which the file was read.
    struct ReadFor {
        bool times = false;  ///< it will be posed at times
        bool uv = false;     ///< keep texture coordinates that no texture reads, too

        bool operator==(const ReadFor&) const = default;
    };

    /// All that the pose and its scene depend on, except the camera.
    struct PreparedFor {
        ImageTime time;
        std::string environment;
        double environment_intensity = 1, environment_rotation_deg = 0;
        bool environment_follows_camera = false;
        bool catcher_ground = false;
        Isa isa = Isa::automatic;

        bool operator==(const PreparedFor&) const = default;
    };

    Result<void> read(const ReadFor& wanted, Log& log);
    Result<ChosenCamera> bring(const RenderRequest& request, const ImageTime& time, Log& log);

    const std::filesystem::path file_;
    gltf::LoadOptions load_;
    ReadFor read_for_;
    std::optional<AssetRenderer> renderer_;  ///< none: the file is read again
    LightingOptions lighting_;
    bool is_posed_ = false;  ///< as stored, not yet prepared
    /// What was set, in that order: to be set again where the file is read again.
    std::vector<std::pair<std::string, std::vector<double>>> values_;
    std::map<size_t, size_t> assigned_;  ///< materials by node, likewise
    bool is_changed_ = false;  ///< by a value, a material or a variant since the latest pose
    bool has_plan_ = false;    ///< of all variants: any may be chosen
    std::optional<PreparedFor> prepared_for_;
};

}  // namespace obscura
