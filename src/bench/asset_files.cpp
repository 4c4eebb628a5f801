// bench/asset_files.cpp - the files that one asset consists of, and the assets in a folder.
// SPDX-License-Identifier: Apache-2.0
#include "bench/asset_files.h"

#include "gltf/document.h"
#include "gltf/file_bytes.h"
#include "gltf/glb.h"
#include "gltf/json_text.h"
#include "gltf/uri.h"

#include <algorithm>
#include <system_error>

namespace obscura {

namespace {

namespace fs = std::filesystem;

std::string_view as_text(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<Document> read_document_of(const fs::path& file) {
    Log silent(Verbosity::quiet);
    const std::string where = file.string();
    const FileBytes whole = read_file_bytes(file, {});
    std::string_view text = as_text(whole.bytes);
    if (is_glb(whole.bytes)) {
        const Result<GlbParts> parts = split_glb(whole.bytes, where, silent);
        if (!parts) return fail(parts.error());
        text = parts->json;
    }
    const Result<nlohmann::json> tree = parse_json_text(text, where, silent);
    if (!tree) return fail(tree.error());
    Problems problems(true);  // whoever loads the asset tells them
    return read_document(*tree, where, problems, silent);
}

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

std::vector<fs::path> files_of_asset(const fs::path& file) {
    std::vector<fs::path> files = {file};
    const Result<Document> document = read_document_of(file);
    if (!document) return files;
    const fs::path folder = file.parent_path();
    for (const GltfBuffer& buffer : document->buffers)
        add_file(folder, buffer.uri, files);
    for (const GltfImage& image : document->images)
        add_file(folder, image.uri, files);
    return files;
}

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
        std::error_code error;
        if (fs::is_directory(folder / "assets", error) && find_assets(folder / "assets")) {
            return folder / "assets";
        }
        if (folder == folder.root_path() || folder.empty()) break;
    }
    return no_assets(start, "no folder 'assets' with scenes lies here or above");
}

}  // namespace obscura
