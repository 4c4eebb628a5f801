// gltf/asset_files.h - lists the files that one glTF asset consists of.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace obscura::gltf {

struct Document;

/// The file itself and every buffer, image and light profile that it names, each once. Files that
/// cannot be read or understood are left out: loading reports them.
std::vector<std::filesystem::path> files_of_asset(const std::filesystem::path& file);

/// The same of one that has been read.
std::vector<std::filesystem::path> files_of_document(const Document& document,
                                                     const std::filesystem::path& file);

}  // namespace obscura::gltf
