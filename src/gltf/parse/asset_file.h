// gltf/parse/asset_file.h - opens a .gltf or .glb file and reads its JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/file_bytes.h"
#include "base/memory_budget.h"
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
    MemoryCharge file_charge = {};  ///< of `file`
    MemoryCharge text_charge = {};  ///< of the JSON's tree, then of the document
};

/// Errors  33 E-MEM; 66 E-SCENE-MISSING, 65 E-GLB-*, those of parse_json_text and read_document
Result<OpenedAsset> open_asset(const std::filesystem::path& path,
                               Problems& problems,
                               Log& log,
                               const MaterialReading& materials);

}  // namespace obscura::gltf
