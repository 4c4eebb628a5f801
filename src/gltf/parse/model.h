// gltf/parse/model.h - tinygltf makes its model of a checked tree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <tiny_gltf.h>

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace obscura {

/// The data of buffers and images are not tinygltf's to read: the tree that it sees has this in
/// their place.
inline constexpr const char* placeholder_uri = "data:application/octet-stream;base64,AA==";

/// The number of a buffer view that is not one of the tree's, in an image and in an accessor
/// without data. read_model adds the view, which tinygltf insists on.
int placeholder_view(const nlohmann::json& tree);

/// Everything but the nodes, which stay in the tree.
///
/// In      tree: as gltf/parse/preflight.h leaves it
/// Out     accessors without data have bufferView -1, images have placeholder_view
/// Errors  70 E-INTERNAL tinygltf refuses what the checks have passed
Result<tinygltf::Model> read_model(nlohmann::json& tree, const std::string& file);

/// Some nodes, and the number of the first one. False: no more are wanted.
using VisitNodes = std::function<bool(const std::vector<tinygltf::Node>& nodes, size_t first)>;

/// The nodes that read_model left, a few thousand at a time: there may be many, and neither their
/// whole tree nor their whole model is kept beside what is made of them.
///
/// Errors  as read_model
Result<void> read_node_parts(nlohmann::json&& tree,
                             const std::string& file,
                             const VisitNodes& visit);

}  // namespace obscura
