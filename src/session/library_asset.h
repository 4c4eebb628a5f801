// session/library_asset.h - what is behind the library's Asset: a file and the images made of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/asset_renderer.h"
#include "session/repeated_log.h"
#include <obscura/session.h>
#include <optional>

namespace obscura {

/// The library's form of an error.
v0::Error library_error(const Error& error);

/// The library's sink as a log's.
LogSink library_sink(const v0::MessageSink& sink);

/// What the pose and everything that was built of it depend on, but for the camera.
struct PreparedFor {
    std::optional<double> time_s;
    std::optional<std::array<double, 2>> shutter_s;
    std::string environment;
    double environment_intensity = 1, environment_rotation_deg = 0;
    Isa isa = Isa::automatic;

    bool operator==(const PreparedFor&) const = default;
};

/// What a file was read for.
struct ReadFor {
    bool times = false;  ///< poses at times will be asked for
    bool uv = false;     ///< texture coordinates that no texture looks up, too

    bool operator==(const ReadFor&) const = default;
};

}  // namespace obscura

namespace obscura::v0 {

struct Asset::Impl {
    Impl(const MessageSink& sink) : log(Verbosity::normal, library_sink(sink)) {}

    Log log;
    RepeatedLog later{log, SettingNames::plain};
    bool has_images = false;  ///< what there was to say has been said
    std::filesystem::path file;
    LoadOptions load;
    ReadFor read_for;
    std::optional<AssetRenderer> renderer;  ///< none: the file is read again
    LightingOptions lighting;
    bool is_posed = false;  ///< as stored, not yet prepared
    std::optional<PreparedFor> prepared_for;
    AssetInfo info;
};

}  // namespace obscura::v0
