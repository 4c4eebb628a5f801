// film/cryptomatte_names.cpp - the names in a scene that Cryptomatte layers know.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte_names.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

namespace obscura {

namespace {

/// Calls `use(node)` once for each node, for its ancestors before.
template <typename Use>
void visit_from_roots(const AssetInfo& info, const Use& use) {
    std::vector<char> is_known(info.node_parents.size(), 0);
    std::vector<size_t> climbed;
    for (size_t node = 0; node < info.node_parents.size(); ++node) {
        for (auto at = static_cast<int32_t>(node);
             at >= 0 && is_known[static_cast<size_t>(at)] == 0;
             at = info.node_parents[static_cast<size_t>(at)]) {
            is_known[static_cast<size_t>(at)] = 1;
            climbed.push_back(static_cast<size_t>(at));
        }
        for (; !climbed.empty(); climbed.pop_back())
            use(climbed.back());
    }
}

/// The path, with a number if it is taken already: siblings may have one name.
///
/// In/Out  taken: the numbers that paths have got so far
std::string unlike_all(const std::string& path, std::map<std::string, int>& taken) {
    const auto [at, is_new] = taken.try_emplace(path, 1);
    if (is_new) return path;
    for (;;) {
        std::string unlike = path + " (" + std::to_string(++at->second) + ")";
        if (taken.try_emplace(unlike, 1).second) return unlike;
    }
}

std::vector<uint32_t> hashes_of(const std::vector<std::string>& names) {
    std::vector<uint32_t> hashes;
    for (const std::string& name : names)
        hashes.push_back(name.empty() ? cryptomatte_no_object : cryptomatte_hash(name));
    return hashes;
}

}  // namespace

std::vector<std::string> node_paths(const AssetInfo& info) {
    // Those of a chain of nodes have a length by the square of its own.
    constexpr size_t longest = 1000;
    std::vector<std::string> paths(info.node_parents.size());
    std::map<std::string, int> taken;
    visit_from_roots(info, [&](size_t node) {
        const int32_t parent = info.node_parents[node];
        std::string path = parent < 0 ? "" : paths[static_cast<size_t>(parent)];
        if (path.size() + 1 + info.node_names[node].size() > longest) path = "/...";
        paths[node] = unlike_all(path + "/" + info.node_names[node], taken);
    });
    return paths;
}

CryptomatteTables cryptomatte_tables(const Scene& scene) {
    const AssetInfo& info = scene.info;
    CryptomatteTables out;
    out.objects = node_paths(info);
    out.assets.resize(out.objects.size());
    visit_from_roots(info, [&](size_t node) {
        const int32_t parent = info.node_parents[node];
        out.assets[node] = parent < 0 ? out.objects[node] : out.assets[static_cast<size_t>(parent)];
    });
    // Number 0 is what belongs to no node.
    out.objects.insert(out.objects.begin(), "");
    out.assets.insert(out.assets.begin(), "");
    out.materials = {"default material"};
    for (size_t i = 0; i < scene.material_names.size(); ++i) {
        if (scene.material_numbers[i] < 0) continue;
        const size_t number = static_cast<size_t>(scene.material_numbers[i]) + 1;
        if (out.materials.size() <= number) out.materials.resize(number + 1);
        const std::string& name = scene.material_names[i];
        out.materials[number] = name.empty() ? "material " + std::to_string(number - 1) : name;
    }
    return out;
}

CryptomatteHashes cryptomatte_hashes(const CryptomatteTables& tables) {
    std::vector<uint32_t> nodes(tables.objects.size());
    std::iota(nodes.begin(), nodes.end(), 0U);
    return {hashes_of(tables.objects),
            hashes_of(tables.materials),
            hashes_of(tables.assets),
            std::move(nodes)};
}

}  // namespace obscura
