// session/library_asset.h - the state behind the library's Asset: a file and its images.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/asset_renderer.h"
#include "session/repeated_log.h"

#include <obscura/session.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// Converts an error to the library's form.
v0::Error library_error(const Error& error);

/// Turns the library's sink into a log's.
LogSink library_sink(const v0::MessageSink& sink);

/// All that the pose and its scene depend on, except the camera.
struct PreparedFor {
    std::optional<double> time_s;
    std::optional<std::array<double, 2>> shutter_s;
    std::string environment;
    double environment_intensity = 1, environment_rotation_deg = 0;
    Isa isa = Isa::automatic;

    bool operator==(const PreparedFor&) const = default;
    bool has_pose_of(const PreparedFor& other) const {
        return time_s == other.time_s && shutter_s == other.shutter_s;
    }
};

/// Purposes for which a file was read.
struct ReadFor {
    bool times = false;  ///< it will be posed at times
    bool uv = false;     ///< keep texture coordinates that no texture reads, too

    bool operator==(const ReadFor&) const = default;
};

}  // namespace obscura

namespace obscura::v0 {

struct Asset::Impl {
    Impl(const MessageSink& sink) : log(Verbosity::normal, library_sink(sink)) {}

    Log log;
    RepeatedLog later{log, SettingNames::plain};
    bool has_images = false;  ///< an image was made: all warnings were given
    std::filesystem::path file;
    gltf::LoadOptions load;
    ReadFor read_for;
    std::optional<AssetRenderer> renderer;  ///< none: the file is read again
    LightingOptions lighting;
    bool is_posed = false;  ///< as stored, not yet prepared
    /// What was set, in that order: to be set again where the file is read again.
    std::vector<std::pair<std::string, std::vector<double>>> values;
    bool is_changed = false;  ///< a value was set or a variant chosen since the latest pose
    bool has_plan = false;    ///< of all variants: any may be chosen
    std::optional<PreparedFor> prepared_for;
    AssetInfo info;
    obscura::AssetInfo graph;  ///< the names and parents of nodes, their meshes; nothing else
};

}  // namespace obscura::v0
