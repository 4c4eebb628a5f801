// render/light_classes.cpp - the light class of every light that light sampling may choose.
// SPDX-License-Identifier: Apache-2.0
#include "render/light_classes.h"

#include "stages/light_paths.h"

#include <algorithm>
#include <span>

namespace obscura {

std::vector<uint16_t> light_classes(const Scene& scene,
                                    const LightGroups& groups,
                                    const LightView& lights) {
    const auto class_of = [&](LightKind kind, uint16_t group) {
        return static_cast<uint16_t>(static_cast<size_t>(kind) * groups.names.size() + group);
    };
    // What is left is the environment, the last light.
    std::vector<uint16_t> out(static_cast<size_t>(std::max(lights.count, 1)),
                              class_of(LightKind::background, groups.environment));
    for (size_t i = 0; i < groups.of_light.size(); ++i)
        out[i] = class_of(LightKind::punctual, groups.of_light[i]);
    const auto group_of_node = [&](int32_t node) {
        const auto index = static_cast<size_t>(node);
        return node >= 0 && index < groups.of_node.size() ? groups.of_node[index] : groups.rest();
    };
    const auto add = [&](const Primitive& primitive, const Instance* instance) {
        const int32_t base =
            primitive.light_base + (instance != nullptr ? instance->light_base : 0);
        if (primitive.light_base < 0 || base < 0) return;
        const uint16_t by_node =
            std::min(group_of_node(primitive.node),
                     instance != nullptr ? group_of_node(instance->node) : groups.rest());
        const uint16_t group =
            std::min(by_node, groups.of_material[static_cast<size_t>(primitive.material)]);
        const auto first = static_cast<size_t>(lights.punctual_count) + static_cast<size_t>(base);
        const size_t count = is_mesh(primitive) ? static_cast<size_t>(primitive.triangle_count) : 1;
        std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(first),
                    std::min(count, out.size() - std::min(first, out.size())),
                    class_of(LightKind::surface, group));
    };
    for (int32_t i = 0; i < scene.world_primitive_count; ++i)
        add(scene.primitives[static_cast<size_t>(i)], nullptr);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const Primitive* const first = &scene.primitives[static_cast<size_t>(mesh.first_primitive)];
        for (const Primitive& primitive :
             std::span(first, static_cast<size_t>(mesh.primitive_count)))
            add(primitive, &instance);
    }
    return out;
}

}  // namespace obscura
