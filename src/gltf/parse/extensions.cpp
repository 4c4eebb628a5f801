// gltf/parse/extensions.cpp - the table of supported extensions, and warnings about others.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/extensions.h"

#include "base/setting_names.h"
#include "gltf/parse/list_text.h"

#include <algorithm>
#include <array>
#include <map>

namespace obscura::gltf {

namespace {

using nlohmann::json;

constexpr std::array extension_entries = {
    ExtensionEntry{"EXT_lights_ies", true, ""},
    ExtensionEntry{"EXT_lights_image_based",
                   true,
                   "",
                   "the finest level is the environment; --env takes its place"},
    ExtensionEntry{"EXT_mesh_gpu_instancing", true, ""},
    ExtensionEntry{"EXT_meshopt_compression", true, ""},
    ExtensionEntry{"EXT_texture_webp", true, "", "the WebP image is preferred"},
    ExtensionEntry{"KHR_animation_pointer", true, "", "played by --time and --frames"},
    ExtensionEntry{"KHR_draco_mesh_compression", true, ""},
    ExtensionEntry{"KHR_gaussian_splatting",
                   true,
                   "",
                   "plain attributes; compressed splats are drawn as points"},
    ExtensionEntry{"KHR_implicit_shapes", true, "", "drawn where a node's OBSCURA_shape names one"},
    ExtensionEntry{"KHR_interactivity", true, "", "a still picture has none", Verdict::ignored},
    ExtensionEntry{"KHR_lights_punctual", true, ""},
    ExtensionEntry{"KHR_materials_anisotropy", true, ""},
    ExtensionEntry{"KHR_materials_clearcoat", true, ""},
    ExtensionEntry{"KHR_materials_diffuse_transmission", true, ""},
    ExtensionEntry{"KHR_materials_dispersion", true, ""},
    ExtensionEntry{"KHR_materials_emissive_strength", true, ""},
    ExtensionEntry{"KHR_materials_ior", true, ""},
    ExtensionEntry{"KHR_materials_iridescence", true, ""},
    ExtensionEntry{"KHR_materials_pbrSpecularGlossiness", true, ""},
    ExtensionEntry{"KHR_materials_sheen", true, ""},
    ExtensionEntry{"KHR_materials_specular", true, ""},
    ExtensionEntry{"KHR_materials_transmission", true, ""},
    ExtensionEntry{"KHR_materials_unlit", true, ""},
    ExtensionEntry{"KHR_materials_variants", true, "", "chosen by --variant"},
    ExtensionEntry{"KHR_materials_volume",
                   true,
                   "",
                   "absorption follows the rays' real way, not the thickness texture"},
    ExtensionEntry{"KHR_materials_volume_scatter",
                   true,
                   "",
                   "light walks at random inside media; a thin wall scatters nothing"},
    ExtensionEntry{"KHR_mesh_quantization", true, ""},
    ExtensionEntry{"KHR_meshopt_compression", true, ""},
    ExtensionEntry{"KHR_node_hoverability", true, "", "a still picture has none", Verdict::ignored},
    ExtensionEntry{
        "KHR_node_selectability", true, "", "a still picture has none", Verdict::ignored},
    ExtensionEntry{"KHR_node_visibility", true, ""},
    ExtensionEntry{
        "KHR_texture_basisu", true, "", "the KTX2 image is preferred, mip levels as stored"},
    ExtensionEntry{"KHR_texture_transform", true, "", "on every texture"},
    ExtensionEntry{"KHR_xmp", true, "", "the asset's packet goes into EXR headers"},
    ExtensionEntry{"KHR_xmp_json_ld", true, "", "the asset's packet goes into EXR headers"},
    ExtensionEntry{"MSFT_lod", true, "", "the finest level is drawn"},
    ExtensionEntry{"OBSCURA_camera", true, ""},
    ExtensionEntry{"OBSCURA_shape", true, ""},
};

/// Where one extension occurs.
struct Uses {
    std::vector<std::string> materials;
    std::vector<std::string> others;
};

using UseMap = std::map<std::string, Uses, std::less<>>;

/// Name of an object for people: "Glass", else "material 3".
std::string object_name(const json& object, std::string_view kind, size_t index) {
    const auto name = object.is_object() ? object.find("name") : object.end();
    if (object.is_object() && name != object.end() && name->is_string()) {
        const std::string& text = name->get_ref<const std::string&>();
        if (!text.empty()) return text;
    }
    return std::string(kind) + " " + std::to_string(index);
}

/// Notes every use in one top-level array.
void collect_uses(const json& tree, const char* array, std::string_view kind, UseMap& uses) {
    const auto found = tree.find(array);
    if (found == tree.end() || !found->is_array()) return;
    size_t index = 0;
    for (const json& object : *found) {
        for (const std::string& name : extension_names(object)) {
            Uses& use = uses[name];
            const bool material = kind == "material";
            std::vector<std::string>& list = material ? use.materials : use.others;
            std::string label = object_name(object, kind, index);
            if (!material && label.rfind(kind, 0) != 0) label = std::string(kind) + " " + label;
            list.push_back(std::move(label));
        }
        ++index;
    }
}

UseMap all_uses(const json& tree) {
    UseMap uses;
    collect_uses(tree, "materials", "material", uses);
    collect_uses(tree, "meshes", "mesh", uses);
    collect_uses(tree, "textures", "texture", uses);
    collect_uses(tree, "nodes", "node", uses);
    collect_uses(tree, "bufferViews", "buffer view", uses);
    collect_uses(tree, "buffers", "buffer", uses);
    collect_uses(tree, "images", "image", uses);
    collect_uses(tree, "scenes", "scene", uses);
    collect_uses(tree, "cameras", "camera", uses);
    collect_uses(tree, "animations", "animation", uses);
    const auto top = tree.find("extensions");
    if (top != tree.end() && top->is_object()) {
        for (const auto& extension : top->items())
            uses[extension.key()];
    }
    return uses;
}

void warn_ignored(const ExtensionInfo& info, const Uses& uses, const Document& document, Log& log) {
    const ExtensionEntry* entry = find_extension(info.name);
    std::string text = info.name + " is not supported";
    if (entry != nullptr) text += ": " + std::string(entry->without);
    if (!uses.materials.empty()) text += "; materials: " + list_text(uses.materials);
    if (!uses.others.empty()) text += "; used by " + list_text(uses.others);
    if (info.required) text += "; the asset says that it cannot be drawn without";
    log.warn(document.file, text);
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::span<const ExtensionEntry> extension_table() {
    return extension_entries;
}

const ExtensionEntry* find_extension(std::string_view name) {
    const auto is_it = [&](const ExtensionEntry& entry) { return entry.name == name; };
    const auto found = std::find_if(extension_entries.begin(), extension_entries.end(), is_it);
    return found == extension_entries.end() ? nullptr : &*found;
}

std::vector<std::string> extension_names(const json& object) {
    std::vector<std::string> names;
    std::vector<const json*> open = {&object};  // the depth of JSON is limited: it stays small
    while (!open.empty()) {
        const json* value = open.back();
        open.pop_back();
        if (value->is_array()) {
            for (const json& element : *value) {
                if (element.is_structured()) open.push_back(&element);
            }
        }
        if (!value->is_object()) continue;
        for (const auto& [key, child] : value->items()) {
            if (key == "extras") continue;
            if (key == "extensions" && child.is_object()) {
                for (const auto& extension : child.items())
                    names.push_back(extension.key());
            }
            if (child.is_structured()) open.push_back(&child);
        }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

Result<void> read_extensions(
    const JsonReader& root, const json& tree, bool lenient, Document& document, Log& log) {
    std::vector<std::string> names = root.texts("extensionsUsed");
    const std::vector<std::string> required = root.texts("extensionsRequired");
    UseMap uses = all_uses(tree);
    for (const auto& entry : uses)
        names.push_back(entry.first);
    names.insert(names.end(), required.begin(), required.end());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());

    std::vector<std::string> missing;
    for (const std::string& name : names) {
        const ExtensionEntry* entry = find_extension(name);
        ExtensionInfo info;
        info.name = name;
        info.required = contains(required, name);
        info.supported = entry != nullptr && entry->supported;
        info.materials = uses[name].materials;
        if (info.required && !info.supported) missing.push_back(name);
        document.extensions.push_back(std::move(info));
    }
    if (!missing.empty() && !lenient) {
        return fail(ExitCode::unsupported,
                    "E-EXT-REQUIRED",
                    document.at("/extensionsRequired"),
                    "the asset requires " + list_text(missing) + ", which is not supported; " +
                        setting("lenient") + " renders without");
    }
    for (const ExtensionInfo& info : document.extensions) {
        if (!info.supported) warn_ignored(info, uses[info.name], document, log);
    }
    return {};
}

}  // namespace obscura::gltf
