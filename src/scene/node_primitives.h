// scene/node_primitives.h - which glTF nodes the primitives in the world belong to.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace obscura {

/// Calls visit(node, instance, primitive) for every primitive as often as it is in the world.
///
/// Out     node: index in glTF, as the layer id_node has it; -1: none.
///         instance: index in Scene::instances; -1: not instanced
template <typename Visit>
void for_each_node_primitive(const Scene& scene, const Visit& visit) {
    for (int32_t i = 0; i < scene.world_primitive_count; ++i) {
        const Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
        visit(primitive.node, int32_t{-1}, primitive);
    }
    for (size_t number = 0; number < scene.instances.size(); ++number) {
        const Instance& instance = scene.instances[number];
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const int32_t end = mesh.first_primitive + mesh.primitive_count;
        for (int32_t i = mesh.first_primitive; i < end; ++i) {
            const Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
            // An instance of an animated group has no node: its primitives tell theirs.
            const int32_t node = std::max(instance.node, primitive.node);
            visit(node, static_cast<int32_t>(number), primitive);
        }
    }
}

/// The name of the mesh of a glTF node; empty: it has none.
inline std::string mesh_name(const AssetInfo& info, size_t node) {
    const int32_t mesh = info.node_meshes[node];
    return mesh < 0 ? "" : info.meshes[static_cast<size_t>(mesh)].name;
}

}  // namespace obscura
