// app/asset_choice.cpp - which scenes a measuring command looks at.
// SPDX-License-Identifier: Apache-2.0
#include "app/asset_choice.h"

#include "bench/asset_files.h"

#include <system_error>

namespace obscura {

Result<std::vector<std::string>> scenes_or_assets(const std::vector<std::string>& scenes,
                                                  const std::optional<std::string>& assets) {
    if (!scenes.empty()) return scenes;
    std::error_code error;
    std::filesystem::path folder = assets.value_or("");
    if (!assets) {
        const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
        const auto found = find_assets_folder(program.parent_path());
        if (!found) return fail(found.error());
        folder = *found;
    }
    const auto files = find_assets(folder);
    if (!files) return fail(files.error());
    std::vector<std::string> names;
    for (const std::filesystem::path& file : *files)
        names.push_back(file.string());
    return names;
}

}  // namespace obscura
