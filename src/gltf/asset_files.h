// gltf/asset_files.h - the files that one glTF asset consists of.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace obscura {

/// The file itself and every buffer, image and light profile that it names, each once. What cannot
/// be read or understood is left out: loading is what complains.
std::vector<std::filesystem::path> files_of_asset(const std::filesystem::path& file);

}  // namespace obscura
