// gltf/parse/animation_pointer.cpp - resolves and writes what KHR_animation_pointer names.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/animation_pointer.h"

#include "gltf/parse/camera_extension.h"
#include "gltf/parse/light_camera_entries.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace obscura::gltf {

namespace {

/// Properties of nodes that are not in tables of their own. To animate one more of a material, a
/// light or a camera, add its entry to the table by which it is read.
struct NodeEntry {
    const char* place;
    ChannelPath path;
    size_t width;  ///< 0: as many as there are weights
    bool in_use = true;
};

constexpr NodeEntry node_entries[] = {
    {"translation", ChannelPath::translation, 3},
    {"rotation", ChannelPath::rotation, 4},
    {"scale", ChannelPath::scale, 3},
    {"weights", ChannelPath::weights, 0},
    {"extensions/KHR_node_visibility/visible", ChannelPath::visible, 1},
    {"extensions/KHR_node_selectability/selectable", ChannelPath::visible, 1, false},
    {"extensions/KHR_node_hoverability/hoverable", ChannelPath::visible, 1, false},
};

constexpr const char* profile_place = "extensions/EXT_lights_ies/";
constexpr const char* transform_place = "/extensions/KHR_texture_transform/";
constexpr const char* camera_place = "extensions/OBSCURA_camera/";
constexpr const char* blades_place = "extensions/OBSCURA_camera/lens/blades";
constexpr const char* lights_place = "/extensions/KHR_lights_punctual/lights/";
constexpr const char* environments_place = "/extensions/EXT_lights_image_based/lights/";

/// A number as JSON pointers write it; -1: it is none.
int index_of(std::string_view text) {
    constexpr size_t max_digits = 9;
    const bool digits = !text.empty() && text.size() <= max_digits &&
                        text.find_first_not_of("0123456789") == std::string_view::npos;
    return digits ? std::stoi(std::string(text)) : -1;
}

/// Removes a prefix; false: the text begins otherwise.
bool take(std::string_view& text, std::string_view beginning) {
    if (text.substr(0, beginning.size()) != beginning) return false;
    text.remove_prefix(beginning.size());
    return true;
}

/// An element of an array, and the pointer's path below it.
struct Below {
    int index;
    std::string_view place;
};

/// Nothing when the pointer leads elsewhere or beyond the array's end.
std::optional<Below> below(std::string_view pointer, std::string_view array, size_t count) {
    if (!take(pointer, array)) return std::nullopt;
    const size_t slash = pointer.find('/');
    if (slash == std::string_view::npos) return std::nullopt;
    const int index = index_of(pointer.substr(0, slash));
    if (index < 0 || static_cast<size_t>(index) >= count) return std::nullopt;
    return Below{index, pointer.substr(slash + 1)};
}

/// How a path matches an entry's: as a whole, by one element, or not at all.
struct Match {
    bool found = false;
    int element = -1;
};

/// In      width: numbers that the entry has; 0: any
Match match(std::string_view place, std::string_view entry, size_t width) {
    if (!take(place, entry)) return {};
    if (place.empty()) return {true, -1};
    if (width == 1 || !take(place, "/")) return {};
    const int element = index_of(place);
    const bool inside = element >= 0 && (width == 0 || static_cast<size_t>(element) < width);
    return inside ? Match{true, element} : Match{};
}

PointedProperty property_of(ChannelPath path, int target, const Match& matched, size_t width) {
    PointedProperty out;
    out.property.path = path;
    out.property.target = target;
    out.property.element = matched.element;
    out.width = matched.element < 0 ? width : 1;
    return out;
}

/// Finds a path in a table of an object's numbers.
template <typename T>
std::optional<PointedProperty> find_entry(std::span<const NumberEntry<T>> entries,
                                          ChannelPath path,
                                          int target,
                                          std::string_view place) {
    T object;
    for (size_t i = 0; i < entries.size(); ++i) {
        const size_t width = entries[i].numbers(object).size();
        const Match matched = match(place, entries[i].place, width);
        if (!matched.found) continue;
        PointedProperty out = property_of(path, target, matched, width);
        out.property.entry = static_cast<int>(i);
        return out;
    }
    return std::nullopt;
}

std::optional<PointedProperty> find_in_node(const Below& node) {
    for (const NodeEntry& entry : node_entries) {
        const Match matched = match(node.place, entry.place, entry.width);
        if (!matched.found) continue;
        PointedProperty out = property_of(entry.path, node.index, matched, entry.width);
        out.in_use = entry.in_use;
        return out;
    }
    std::string_view place = node.place;
    if (!take(place, profile_place)) return std::nullopt;
    return find_entry(profile_entries, ChannelPath::profile, node.index, place);
}

std::optional<PointedProperty> find_in_mesh(const Below& mesh) {
    const Match matched = match(mesh.place, "weights", 0);
    if (!matched.found) return std::nullopt;
    return property_of(ChannelPath::mesh_weights, mesh.index, matched, 0);
}

std::optional<PointedProperty> find_in_environment(const Below& light) {
    const Match matched = match(light.place, "rotation", 4);
    if (matched.found) {
        return property_of(ChannelPath::environment_rotation, light.index, matched, 4);
    }
    return find_entry(environment_entries, ChannelPath::environment, light.index, light.place);
}

std::optional<PointedProperty> find_in_light(const Below& below, const GltfLight& light) {
    if (light.type != GltfLightType::spot && below.place.substr(0, 5) == "spot/") {
        return std::nullopt;
    }
    return find_entry(light_entries, ChannelPath::light, below.index, below.place);
}

/// A number of OBSCURA_camera that the file gives; of a list only the elements.
std::optional<PointedProperty> find_lens_number(const Below& camera, CameraSettings settings) {
    if (camera.place == blades_place) {
        if (!settings.blades) return std::nullopt;
        return property_of(ChannelPath::blades, camera.index, {}, 1);
    }
    std::string_view place = camera.place;
    if (!take(place, camera_place)) return std::nullopt;
    for (size_t i = 0; i < lens_entries.size(); ++i) {
        const size_t width = lens_entries[i].numbers(settings).size();
        if (width == 0 || lens_entries[i].info.key == nullptr) continue;
        const Match matched = match(place, lens_place(lens_entries[i].info), width);
        if (!matched.found || (width > 1 && matched.element < 0)) continue;
        PointedProperty out = property_of(ChannelPath::lens, camera.index, matched, 1);
        out.property.entry = static_cast<int>(i);
        return out;
    }
    return std::nullopt;
}

std::optional<PointedProperty> find_in_camera(const Below& below, const GltfCamera& camera) {
    const auto entries = camera.orthographic ? orthographic_entries : perspective_entries;
    const auto out = find_entry(entries, ChannelPath::camera, below.index, below.place);
    return out ? out : find_lens_number(below, camera.settings);
}

std::string place_of(const MaterialEntry& entry) {
    const std::string object = entry.object.place;
    return object + (object.empty() ? "" : "/") + entry.key;
}

/// A number of KHR_texture_transform of the texture that an entry names.
std::optional<PointedProperty> find_transform(const Below& material, size_t texture_entry) {
    std::string_view place = material.place;
    if (!take(place, place_of(material_entries[texture_entry])) || !take(place, transform_place)) {
        return std::nullopt;
    }
    auto out = find_entry(transform_entries, ChannelPath::texture_transform, material.index, place);
    if (out) out->property.texture = static_cast<int>(texture_entry);
    return out;
}

std::optional<PointedProperty> find_in_material(const Below& material,
                                                const MaterialFactors& factors) {
    MaterialFactors any;
    for (size_t i = 0; i < material_entries.size(); ++i) {
        const MaterialEntry& entry = material_entries[i];
        if (entry.texture != nullptr && !(factors.*entry.texture).given) continue;
        if (entry.numbers == nullptr) {
            const std::optional<PointedProperty> out = find_transform(material, i);
            if (out) return out;
            continue;
        }
        const size_t width = entry.numbers(any).size();
        const Match matched = match(material.place, place_of(entry), width);
        if (!matched.found) continue;
        PointedProperty out = property_of(ChannelPath::material, material.index, matched, width);
        out.property.entry = static_cast<int>(i);
        return out;
    }
    return std::nullopt;
}

template <typename T>
T& at(std::vector<T>& array, int index) {
    return array[static_cast<size_t>(index)];
}

template <typename Entries>
const auto& at(const Entries& entries, int index) {
    return entries[static_cast<size_t>(index)];
}

void write(const AnimatedProperty& property,
           std::span<const double> value,
           const NumberLimits& limits,
           std::span<double> out) {
    if (property.element >= 0) out = out.subspan(static_cast<size_t>(property.element), 1);
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = clamped(value[i], limits);
}

void set_in_node(const AnimatedProperty& property, std::span<const double> value, GltfNode& node) {
    const bool moved = property.path == ChannelPath::translation;
    if (property.path == ChannelPath::rotation) {
        write(property, value, {}, node.trs.rotation);
    } else {
        write(property, value, {}, moved ? node.trs.translation : node.trs.scale);
    }
}

void set_in_material(const AnimatedProperty& property,
                     std::span<const double> value,
                     MaterialFactors& factors) {
    const bool transforms = property.path == ChannelPath::texture_transform;
    const MaterialEntry& entry =
        at(material_entries, transforms ? property.texture : property.entry);
    factors.extensions |= entry.object.extensions;
    if (!transforms) {
        write(property, value, entry.limits, entry.numbers(factors));
        return;
    }
    TextureFactors& texture = factors.*entry.texture;
    texture.transformed = true;
    const NumberEntry<TextureFactors>& number = at(transform_entries, property.entry);
    write(property, value, number.limits, number.numbers(texture));
}

struct LensFault {
    const char* id;
    std::string message;
};

tl::unexpected<Error> bad_lens(const Document& document,
                               int camera,
                               const std::string& place,
                               const LensFault& fault) {
    const std::string pointer = "/cameras/" + std::to_string(camera) + "/" + place;
    return fail(ExitCode::bad_data, fault.id, document.at(pointer), fault.message);
}

Result<void> set_lens_number(const AnimatedProperty& property,
                             std::span<const double> value,
                             Document& document) {
    const LensEntry& entry = at(lens_entries, property.entry);
    const auto wrong = lens_fault(entry.info, value);
    if (wrong) {
        const std::string place = camera_place + lens_place(entry.info);
        return bad_lens(document, property.target, place, {camera_value_id, *wrong});
    }
    write(property, value, {}, entry.numbers(at(document.cameras, property.target).settings));
    return {};
}

Result<void> set_blades(int camera, double value, Document& document) {
    if (value < 0 || value != std::floor(value)) {
        return bad_lens(document, camera, blades_place, {"E-JSON-TYPE", "it must be an integer"});
    }
    constexpr CameraSettingInfo info = camera_setting_of<&CameraSettings::blades>().info;
    if (const auto wrong = count_fault(info, value)) {
        return bad_lens(document, camera, blades_place, {camera_value_id, *wrong});
    }
    at(document.cameras, camera).settings.blades = static_cast<int>(value);
    return {};
}

template <typename T>
void set_entry(std::span<const NumberEntry<T>> entries,
               const AnimatedProperty& property,
               std::span<const double> value,
               T& object) {
    const NumberEntry<T>& entry = at(entries, property.entry);
    write(property, value, entry.limits, entry.numbers(object));
}

}  // namespace

std::optional<PointedProperty> find_property(const Document& document, const std::string& pointer) {
    if (const auto node = below(pointer, "/nodes/", document.nodes.size())) {
        return find_in_node(*node);
    }
    if (const auto mesh = below(pointer, "/meshes/", document.meshes.size())) {
        return find_in_mesh(*mesh);
    }
    if (const auto camera = below(pointer, "/cameras/", document.cameras.size())) {
        return find_in_camera(*camera, at(document.cameras, camera->index));
    }
    if (const auto light = below(pointer, lights_place, document.lights.size())) {
        return find_in_light(*light, at(document.lights, light->index));
    }
    if (const auto light = below(pointer, environments_place, document.environments.size())) {
        return find_in_environment(*light);
    }
    if (const auto material = below(pointer, "/materials/", document.material_factors.size())) {
        return find_in_material(*material, at(document.material_factors, material->index));
    }
    return std::nullopt;
}

std::vector<std::string> property_patterns() {
    std::vector<std::string> out;
    const auto add_entries = [&](const std::string& object, const auto& entries) {
        for (const auto& entry : entries)
            out.push_back(object + entry.place);
    };
    add_entries("/nodes/*/", node_entries);
    add_entries(std::string("/nodes/*/") + profile_place, profile_entries);
    out.emplace_back("/meshes/*/weights");
    for (const MaterialEntry& entry : material_entries) {
        if (entry.numbers != nullptr) out.push_back("/materials/*/" + place_of(entry));
    }
    add_entries(std::string("/materials/*/TEXTURE") + transform_place, transform_entries);
    add_entries(std::string(lights_place) + "*/", light_entries);
    add_entries(std::string(environments_place) + "*/", environment_entries);
    out.push_back(std::string(environments_place) + "*/rotation");
    add_entries("/cameras/*/", perspective_entries);
    add_entries("/cameras/*/", orthographic_entries);
    for (const LensEntry& entry : lens_entries) {
        if (entry.is_real && entry.info.key != nullptr) {
            out.push_back("/cameras/*/" + (camera_place + lens_place(entry.info)));
        }
    }
    out.push_back(std::string("/cameras/*/") + blades_place);
    return out;
}

Result<void> set_property(const AnimatedProperty& property,
                          std::span<const double> value,
                          Document& document) {
    const int target = property.target;
    switch (property.path) {
        case ChannelPath::translation:
        case ChannelPath::rotation:
        case ChannelPath::scale:
            set_in_node(property, value, at(document.nodes, target));
            break;
        case ChannelPath::weights:
        case ChannelPath::mesh_weights:
        case ChannelPath::visible:
            break;
        case ChannelPath::profile:
            set_entry(profile_entries, property, value, at(document.nodes, target).ies);
            break;
        case ChannelPath::environment:
            set_entry(environment_entries, property, value, at(document.environments, target));
            break;
        case ChannelPath::environment_rotation:
            write(property, value, {}, at(document.environments, target).rotation);
            break;
        case ChannelPath::material:
        case ChannelPath::texture_transform:
            set_in_material(property, value, at(document.material_factors, target));
            break;
        case ChannelPath::light:
            set_entry(light_entries, property, value, at(document.lights, target));
            finish_range(at(document.lights, target));
            break;
        case ChannelPath::camera: {
            GltfCamera& camera = at(document.cameras, target);
            set_entry(camera.orthographic ? orthographic_entries : perspective_entries,
                      property,
                      value,
                      camera);
            break;
        }
        case ChannelPath::lens:
            return set_lens_number(property, value, document);
        case ChannelPath::blades:
            return set_blades(target, value[0], document);
    }
    return {};
}

}  // namespace obscura::gltf
