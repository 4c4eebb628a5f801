// gltf/parse/asset_file.h - opens a .gltf or .glb file and reads its JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/file_bytes.h"
#include "gltf/parse/document.h"

#include <filesystem>
#include <optional>
#include <span>

namespace obscura::gltf {

/// An asset's file taken apart, with its JSON already read.
struct OpenedAsset {
    Bytes file;  ///< what glb_binary points into
    std::optional<std::span<const std::byte>> glb_binary;
    Document document;
};

/// Errors  66 E-SCENE-MISSING, 65 E-GLB-*, those of parse_json_text and read_document
Result<OpenedAsset> open_asset(const std::filesystem::path& path,
                               Problems& problems,
                               Log& log,
                               const MaterialReading& materials);

}  // namespace obscura::gltf
