// session/library_asset.h - the state behind the library's Asset: a file and its images.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/open_asset.h"
#include "session/repeated_log.h"

#include <obscura/session.h>

namespace obscura {

/// Converts an error to the library's form.
v0::Error library_error(const Error& error);

/// Turns the library's sink into a log's.
LogSink library_sink(const v0::MessageSink& sink);

}  // namespace obscura

namespace obscura::v0 {

struct Asset::Impl {
    Impl(const MessageSink& sink, std::filesystem::path file, gltf::LoadOptions load)
        : log(Verbosity::normal, library_sink(sink), SettingNames::fields),
          asset(std::move(file), std::move(load)) {}

    Log log;
    RepeatedLog later{log, SettingNames::fields};
    bool has_images = false;  ///< an image was made: all warnings were given
    OpenAsset asset;
    AssetInfo info;
    obscura::AssetInfo graph;  ///< the names and parents of nodes, their meshes; nothing else
};

}  // namespace obscura::v0
