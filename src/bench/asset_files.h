// bench/asset_files.h - finds the assets in a folder and reads their files' bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <filesystem>
#include <vector>

namespace obscura::bench {

/// Reads files one after the other and returns the sum of their sizes.
size_t read_all(const std::vector<std::filesystem::path>& files);

/// Every .gltf and .glb below a folder, by path.
///
/// Errors  67 E-BENCH-ASSETS there are none, or the folder cannot be read
Result<std::vector<std::filesystem::path>> find_assets(const std::filesystem::path& folder);

/// The first folder "assets" or "share/obscura/assets" with scenes in it, in `start` or above it.
///
/// Errors  67 E-BENCH-ASSETS
Result<std::filesystem::path> find_assets_folder(const std::filesystem::path& start);

}  // namespace obscura::bench
