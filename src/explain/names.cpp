// explain/names.cpp - names of objects and materials in a report.
// SPDX-License-Identifier: Apache-2.0
#include "explain/names.h"

#include "base/log.h"

#include <fmt/format.h>

namespace obscura {

namespace {

const Primitive& primitive_of(const Scene& scene, const crosscheck::Item& item) {
    return scene.primitives[static_cast<size_t>(item.primitive)];
}

std::string kind_of(const crosscheck::TrueScene& scene, const crosscheck::Item& item) {
    if (scene.is_triangle(item)) return fmt::format("triangle {}", item.element);
    if (scene.is_segment(item)) return fmt::format("segment {} of a line", item.element);
    const auto kind = static_cast<GeometryKind>(primitive_of(scene.scene(), item).geometry);
    if (kind == GeometryKind::spheres) return fmt::format("particle {}", item.element);
    const ShapeRecord record = scene.shape(item);
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            return "sphere";
        case ShapeKind::box:
            return "box";
        case ShapeKind::frustum:
            return record.size[1] == record.size[2] ? "cylinder" : "cone";
        case ShapeKind::capsule:
            return "capsule";
        case ShapeKind::plane:
            return "plane";
        case ShapeKind::disk:
            return "disk";
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return "quadric";
}

int32_t node_of(const Scene& scene, const crosscheck::Item& item) {
    if (item.instance < 0) return primitive_of(scene, item).node;
    return scene.instances[static_cast<size_t>(item.instance)].node;
}

}  // namespace

std::string name_of_item(const crosscheck::TrueScene& scene, const crosscheck::Item& item) {
    const int32_t node = node_of(scene.scene(), item);
    std::string text = kind_of(scene, item);
    if (node < 0) return text;
    text += fmt::format(" of node {}", node);
    const std::vector<std::string>& names = scene.scene().info.node_names;
    const auto number = static_cast<size_t>(node);
    if (number >= names.size() || names[number].empty()) return text;
    return text + " '" + escape_control(names[number]) + "'";
}

const Material& material_of(const Scene& scene, const crosscheck::Item& item) {
    return scene.materials[static_cast<size_t>(primitive_of(scene, item).material)];
}

std::string name_of_material(const Scene& scene, const crosscheck::Item& item) {
    const auto index = static_cast<size_t>(primitive_of(scene, item).material);
    const bool named = index < scene.material_names.size() && !scene.material_names[index].empty();
    return named ? escape_control(scene.material_names[index]) : "default material";
}

}  // namespace obscura
