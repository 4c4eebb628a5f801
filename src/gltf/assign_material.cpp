// gltf/assign_material.cpp - gives a node a material other than the file's.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/assign_material.h"

#include <algorithm>
#include <string>

namespace obscura::gltf {

namespace {

tl::unexpected<Error> unknown(const char* kind, size_t number, const std::string& message) {
    const std::string where = std::string("/") + kind + "/" + std::to_string(number);
    return fail(ExitCode::usage, "E-SET-UNKNOWN", where, message);
}

bool is_shared(int mesh, const Document& document) {
    const auto draws = [&](const GltfNode& node) { return node.mesh == mesh; };
    return std::count_if(document.nodes.begin(), document.nodes.end(), draws) > 1;
}

}  // namespace

Result<void> assign_material(size_t node, size_t material, Document& document) {
    if (node >= document.nodes.size()) return unknown("nodes", node, "the asset has no such node");
    if (material >= document.materials.size())
        return unknown("materials", material, "the asset has no such material");
    GltfNode& to = document.nodes[node];
    if (to.mesh < 0 && to.shape < 0)
        return unknown("nodes", node, "the node draws nothing; expected one with a mesh or shape");
    const auto number = static_cast<int>(material);
    if (to.shape >= 0) to.shape_material = number;
    if (to.mesh < 0) return {};
    if (is_shared(to.mesh, document)) {
        document.meshes.push_back(document.meshes[static_cast<size_t>(to.mesh)]);
        to.mesh = static_cast<int>(document.meshes.size()) - 1;
    }
    for (GltfPrimitive& primitive : document.meshes[static_cast<size_t>(to.mesh)].primitives)
        primitive.assigned_material = primitive.material = number;
    return {};
}

}  // namespace obscura::gltf
