// film/cryptomatte_names.h - the names in a scene that Cryptomatte layers know.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/layer_sums.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace obscura {

/// The path of every glTF node, from its root: "/lamp/shade". No two are alike: of siblings of one
/// name the second is "/lamp (2)". Where one would be longer than 1000 bytes, "/..." stands for all
/// ancestors.
std::vector<std::string> node_paths(const AssetInfo& info);

/// The name that every number of an id AOV (index plus 1) stands for in a Cryptomatte layer.
struct CryptomatteTables {
    std::vector<std::string> objects;    ///< by id_node: the node's path
    std::vector<std::string> materials;  ///< by id_material: the material's name
    std::vector<std::string> assets;     ///< by id_node: its root's path
};

CryptomatteTables cryptomatte_tables(const Scene& scene);

CryptomatteHashes cryptomatte_hashes(const CryptomatteTables& tables);

}  // namespace obscura
