// gltf/asset_files.cpp - lists the files that one glTF asset consists of.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/asset_files.h"

#include "gltf/parse/asset_file.h"
#include "gltf/parse/uri.h"

#include <algorithm>
#include <optional>

namespace obscura::gltf {

namespace {

namespace fs = std::filesystem;

void add_file(const fs::path& folder,
              const std::optional<std::string>& uri,
              std::vector<fs::path>& files) {
    if (!uri || is_data_uri(*uri)) return;
    const Result<fs::path> relative = relative_path_from_uri(*uri, "");
    if (!relative) return;
    fs::path file = folder / *relative;
    if (std::find(files.begin(), files.end(), file) == files.end()) {
        files.push_back(std::move(file));
    }
}

}  // namespace

std::vector<fs::path> files_of_document(const Document& document, const fs::path& file) {
    std::vector<fs::path> files = {file};
    const fs::path folder = file.parent_path();
    for (const GltfBuffer& buffer : document.buffers)
        add_file(folder, buffer.uri, files);
    for (const GltfImage& image : document.images)
        add_file(folder, image.uri, files);
    for (const GltfLightProfile& profile : document.profiles)
        add_file(folder, profile.uri, files);
    return files;
}

std::vector<fs::path> files_of_asset(const fs::path& file) {
    Log silent(Verbosity::quiet);
    Problems problems(true);  // reported when the asset is loaded
    const Result<OpenedAsset> asset = open_asset(file, problems, silent, {});
    if (!asset) return {file};
    return files_of_document(asset->document, file);
}

}  // namespace obscura::gltf
