// bench/asset_files.cpp - finds the assets in a folder and reads their files' bytes.
// SPDX-License-Identifier: Apache-2.0
#include "bench/asset_files.h"

#include "base/file_bytes.h"

#include <algorithm>
#include <system_error>

namespace obscura::bench {

namespace {

namespace fs = std::filesystem;

bool is_asset(const fs::directory_entry& entry) {
    const fs::path extension = entry.path().extension();
    std::error_code error;
    return (extension == ".gltf" || extension == ".glb") && entry.is_regular_file(error);
}

tl::unexpected<Error> no_assets(const fs::path& folder, const std::string& what) {
    return fail(ExitCode::bad_resource,
                "E-BENCH-ASSETS",
                folder.string(),
                what + "; give a SCENE, or --assets and a folder with .gltf or .glb files");
}

}  // namespace

size_t read_all(const std::vector<fs::path>& files) {
    size_t sum = 0;
    for (const fs::path& file : files)
        sum += read_file_bytes(file, {}).bytes.size();
    return sum;
}

Result<std::vector<fs::path>> find_assets(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    fs::recursive_directory_iterator entries(folder, error);
    for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
        if (is_asset(*entries)) found.push_back(entries->path());
    }
    if (error) return no_assets(folder, error.message());
    if (found.empty()) return no_assets(folder, "there is no .gltf or .glb file in this folder");
    std::sort(found.begin(), found.end());
    return found;
}

Result<fs::path> find_assets_folder(const fs::path& start) {
    for (fs::path folder = start;; folder = folder.parent_path()) {
        for (const char* below : {"assets", "share/obscura/assets"}) {  // as built, as installed
            std::error_code error;
            if (fs::is_directory(folder / below, error) && find_assets(folder / below))
                return folder / below;
        }
        if (folder == folder.root_path() || folder.empty()) break;
    }
    return no_assets(start,
                     "no folder 'assets' or 'share/obscura/assets' with scenes lies here or above");
}

}  // namespace obscura::bench
