// gltf/animation_pointer.cpp - which property a pointer of KHR_animation_pointer names.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation_pointer.h"

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace obscura {

namespace {

using nlohmann::json;

/// A property; * stands for an index. To animate one more of a material, a light or a camera, add
/// its row: it is read again by the reader that read it first.
struct PropertyRow {
    const char* pattern;
    size_t width;  ///< 0: as many as there are weights
    ChannelPath path = ChannelPath::json;
    bool in_use = true;
};

constexpr PropertyRow property_rows[] = {
    {"/nodes/*/translation", 3, ChannelPath::translation},
    {"/nodes/*/rotation", 4, ChannelPath::rotation},
    {"/nodes/*/scale", 3, ChannelPath::scale},
    {"/nodes/*/weights", 0, ChannelPath::weights},
    {"/nodes/*/weights/*", 1, ChannelPath::weights},
    {"/nodes/*/extensions/KHR_node_visibility/visible", 1, ChannelPath::visible},
    {"/nodes/*/extensions/EXT_lights_ies/multiplier", 1, ChannelPath::profile_multiplier},
    {"/nodes/*/extensions/EXT_lights_ies/color", 3, ChannelPath::profile_color},
    {"/extensions/EXT_lights_image_based/lights/*/intensity",
     1,
     ChannelPath::environment_intensity},
    {"/extensions/EXT_lights_image_based/lights/*/rotation", 4, ChannelPath::environment_rotation},
    {"/nodes/*/extensions/KHR_node_selectability/selectable", 1, ChannelPath::visible, false},
    {"/nodes/*/extensions/KHR_node_hoverability/hoverable", 1, ChannelPath::visible, false},
    {"/meshes/*/weights", 0, ChannelPath::mesh_weights},
    {"/meshes/*/weights/*", 1, ChannelPath::mesh_weights},
    {"/cameras/*/orthographic/xmag", 1},
    {"/cameras/*/orthographic/ymag", 1},
    {"/cameras/*/orthographic/zfar", 1},
    {"/cameras/*/orthographic/znear", 1},
    {"/cameras/*/perspective/aspectRatio", 1},
    {"/cameras/*/perspective/yfov", 1},
    {"/cameras/*/perspective/zfar", 1},
    {"/cameras/*/perspective/znear", 1},
    {"/extensions/KHR_lights_punctual/lights/*/color", 3},
    {"/extensions/KHR_lights_punctual/lights/*/intensity", 1},
    {"/extensions/KHR_lights_punctual/lights/*/range", 1},
    {"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", 1},
    {"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", 1},
    {"/materials/*/alphaCutoff", 1},
    {"/materials/*/emissiveFactor", 3},
    {"/materials/*/normalTexture/scale", 1},
    {"/materials/*/occlusionTexture/strength", 1},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", 4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", 1},
    {"/materials/*/pbrMetallicRoughness/roughnessFactor", 1},
    {"/materials/*/extensions/KHR_materials_anisotropy/anisotropyRotation", 1},
    {"/materials/*/extensions/KHR_materials_anisotropy/anisotropyStrength", 1},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", 1},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", 1},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 1},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
     3},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 1},
    {"/materials/*/extensions/KHR_materials_dispersion/dispersion", 1},
    {"/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", 1},
    {"/materials/*/extensions/KHR_materials_ior/ior", 1},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceFactor", 1},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceIor", 1},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", 1},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", 1},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 4},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", 1},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", 3},
    {"/materials/*/extensions/KHR_materials_sheen/sheenColorFactor", 3},
    {"/materials/*/extensions/KHR_materials_sheen/sheenRoughnessFactor", 1},
    {"/materials/*/extensions/KHR_materials_specular/specularColorFactor", 3},
    {"/materials/*/extensions/KHR_materials_specular/specularFactor", 1},
    {"/materials/*/extensions/KHR_materials_transmission/transmissionFactor", 1},
    {"/materials/*/extensions/KHR_materials_volume/attenuationColor", 3},
    {"/materials/*/extensions/KHR_materials_volume/attenuationDistance", 1},
    {"/materials/*/extensions/KHR_materials_volume/thicknessFactor", 1},
    {"/materials/*/extensions/KHR_materials_volume_scatter/multiscatterColor", 3},
    {"/materials/*/extensions/KHR_materials_volume_scatter/scatterAnisotropy", 1},
};

/// What lies behind a texture's own path.
constexpr PropertyRow transform_rows[] = {
    {"/extensions/KHR_texture_transform/offset", 2},
    {"/extensions/KHR_texture_transform/rotation", 1},
    {"/extensions/KHR_texture_transform/scale", 2},
};

std::vector<std::string_view> split(std::string_view pointer) {
    std::vector<std::string_view> out;
    while (!pointer.empty()) {
        const size_t end = pointer.find('/', 1);
        out.push_back(pointer.substr(1, end == std::string_view::npos ? end : end - 1));
        pointer = end == std::string_view::npos ? std::string_view() : pointer.substr(end);
    }
    return out;
}

/// A number as JSON pointers write it; -1: it is none.
int index_of(std::string_view text) {
    constexpr size_t most_digits = 9;
    const bool digits = !text.empty() && text.size() <= most_digits &&
                        text.find_first_not_of("0123456789") == std::string_view::npos;
    return digits ? std::stoi(std::string(text)) : -1;
}

/// The indices where the pattern has a *; nothing: they do not agree.
std::optional<std::vector<int>> match(const char* pattern, std::string_view pointer) {
    const std::vector<std::string_view> wanted = split(pattern);
    const std::vector<std::string_view> given = split(pointer);
    if (wanted.size() != given.size()) return std::nullopt;
    std::vector<int> indices;
    for (size_t i = 0; i < given.size(); ++i) {
        if (wanted[i] != "*") {
            if (wanted[i] != given[i]) return std::nullopt;
            continue;
        }
        indices.push_back(index_of(given[i]));
        if (indices.back() < 0) return std::nullopt;
    }
    return indices;
}

const json* value_at(const json& tree, std::string_view pointer) {
    const json* value = &tree;
    for (const std::string_view key : split(pointer)) {
        if (value->is_array()) {
            const int index = index_of(key);
            if (index < 0 || static_cast<size_t>(index) >= value->size()) return nullptr;
            value = &(*value)[static_cast<size_t>(index)];
            continue;
        }
        if (!value->is_object()) return nullptr;
        const auto found = value->find(std::string(key));
        if (found == value->end()) return nullptr;
        value = &*found;
    }
    return value;
}

std::string_view parent_of(std::string_view pointer) {
    return pointer.substr(0, pointer.rfind('/'));
}

/// Properties may be left out where they have their default, and so may the objects that hold
/// nothing else; a texture, a lens or a cone must exist.
bool has_owner(const json& tree, std::string_view pointer) {
    std::string_view owner = parent_of(pointer);
    const json* direct = value_at(tree, owner);
    if (direct != nullptr) return direct->is_object();
    constexpr std::string_view core = "/pbrMetallicRoughness";
    constexpr std::string_view extensions = "/extensions";
    if (owner.size() > core.size() && owner.substr(owner.size() - core.size()) == core) {
        owner = parent_of(owner);
    }
    const std::string_view above = parent_of(owner);
    if (above.size() > extensions.size() &&
        above.substr(above.size() - extensions.size()) == extensions) {
        owner = parent_of(above);
    }
    const json* value = value_at(tree, owner);
    return value != nullptr && value->is_object();
}

/// A texture of a material, wherever in it.
bool is_texture(const json& tree, std::string_view pointer) {
    const std::vector<std::string_view> keys = split(pointer);
    if (keys.size() < 3 || keys[0] != "materials") return false;
    const json* value = value_at(tree, pointer);
    return value != nullptr && value->is_object() && value->contains("index");
}

std::optional<PointedProperty> find_transform(const json& tree, const std::string& pointer) {
    for (const PropertyRow& row : transform_rows) {
        const std::string_view tail = row.pattern;
        if (pointer.size() <= tail.size()) continue;
        const std::string_view texture(pointer.data(), pointer.size() - tail.size());
        if (pointer.substr(texture.size()) != tail || !is_texture(tree, texture)) continue;
        return PointedProperty{ChannelPath::json, -1, -1, row.width, true};
    }
    return std::nullopt;
}

/// A number of OBSCURA_camera that the file gives.
std::optional<PointedProperty> find_lens_number(const json& tree, const std::string& pointer) {
    const std::vector<std::string_view> keys = split(pointer);
    if (keys.size() < 5 || keys[0] != "cameras" || keys[3] != "OBSCURA_camera") return std::nullopt;
    const json* value = value_at(tree, pointer);
    if (value == nullptr || !value->is_number()) return std::nullopt;
    return PointedProperty{};
}

}  // namespace

std::optional<PointedProperty> find_property(const json& tree, const std::string& pointer) {
    if (pointer.empty() || pointer[0] != '/') return std::nullopt;
    for (const PropertyRow& row : property_rows) {
        const std::optional<std::vector<int>> indices = match(row.pattern, pointer);
        if (!indices) continue;
        PointedProperty out{row.path, indices->front(), -1, row.width, row.in_use};
        if (indices->size() > 1) out.element = (*indices)[1];
        // The weights of a node or mesh are checked by whoever knows their number.
        const bool in_array = row.width == 0 || indices->size() > 1;
        const std::string_view owner = indices->size() > 1 ? parent_of(pointer) : pointer;
        const bool exists =
            in_array ? value_at(tree, parent_of(owner)) != nullptr : has_owner(tree, pointer);
        return exists ? std::optional(out) : std::nullopt;
    }
    std::optional<PointedProperty> out = find_transform(tree, pointer);
    return out ? out : find_lens_number(tree, pointer);
}

}  // namespace obscura
