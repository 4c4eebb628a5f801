// app/asset_choice.cpp - chooses the scenes of a measuring command.
// SPDX-License-Identifier: Apache-2.0
#include "app/asset_choice.h"

#include "bench/asset_files.h"

#include <system_error>

namespace obscura::app {

namespace {

Result<std::vector<std::string>> scenes_or_assets(const std::vector<std::string>& scenes,
                                                  const std::optional<std::string>& assets) {
    if (!scenes.empty()) return scenes;
    std::error_code error;
    std::filesystem::path folder = assets.value_or("");
    if (!assets) {
        const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
        const auto found = bench::find_assets_folder(program.parent_path());
        if (!found) return fail(found.error());
        folder = *found;
    }
    const auto files = bench::find_assets(folder);
    if (!files) return fail(files.error());
    std::vector<std::string> names;
    for (const std::filesystem::path& file : *files)
        names.push_back(file.string());
    return names;
}

}  // namespace

Result<std::vector<RenderRequest>> requests_for(
    const std::vector<std::string>& scenes,
    const std::optional<std::string>& assets,
    const std::function<Result<RenderRequest>(const std::string&)>& request_for) {
    const Result<std::vector<std::string>> names = scenes_or_assets(scenes, assets);
    if (!names) return fail(names.error());
    std::vector<RenderRequest> requests;
    for (const std::string& name : *names) {
        Result<RenderRequest> one = request_for(name);
        if (!one) return fail(one.error());
        requests.push_back(std::move(*one));
    }
    return requests;
}

}  // namespace obscura::app
