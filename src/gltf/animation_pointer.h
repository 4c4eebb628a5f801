// gltf/animation_pointer.h - which property a pointer of KHR_animation_pointer names.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/document_animation.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace obscura {

/// One place of the glTF 2.0 Asset Object Model.
struct PointedProperty {
    ChannelPath path = ChannelPath::json;
    int target = -1;     ///< node, mesh or light, unless path is json
    int element = -1;    ///< of /weights/3
    size_t width = 1;    ///< numbers in a value; 0: as many as there are weights
    bool in_use = true;  ///< false: known, but a picture does not show it
};

/// Finds what a JSON pointer names in the asset `tree`; nothing: it leads to nothing that can be
/// animated. Materials with all their extensions, texture transforms, lights, cameras (the core and
/// OBSCURA_camera), weights of meshes; translation, rotation, scale, weights and visibility of
/// nodes.
///
/// Source  Khronos, "glTF 2.0 Asset Object Model Specification"; KHR_animation_pointer
std::optional<PointedProperty> find_property(const nlohmann::json& tree,
                                             const std::string& pointer);

}  // namespace obscura
