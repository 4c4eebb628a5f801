// gltf/parse/model.h - makes tinygltf's model from a checked JSON tree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <tiny_gltf.h>

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace obscura::gltf {

/// Stands in the tree for the data of buffers and images, which tinygltf must not read.
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

/// Takes some nodes and the number of the first one. False: no more are wanted.
using VisitNodes = std::function<bool(const std::vector<tinygltf::Node>& nodes, size_t first)>;

/// Reads the nodes that read_model left, a few thousand at a time, so that memory never holds their
/// whole tree or model beside the result.
///
/// Errors  as read_model
Result<void> read_node_parts(nlohmann::json&& tree,
                             const std::string& file,
                             const VisitNodes& visit);

}  // namespace obscura::gltf
