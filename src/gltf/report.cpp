// gltf/report.cpp - reports which features each part of a file uses, and their support.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/report.h"

#include <algorithm>
#include <array>

namespace obscura::gltf {

namespace {

using nlohmann::json;

/// A top-level array, and what one of its elements is called.
struct TopLevelArray {
    const char* array;
    const char* name;
};

constexpr std::array top_level_arrays = {TopLevelArray{"scenes", "scene"},
                                         TopLevelArray{"nodes", "node"},
                                         TopLevelArray{"cameras", "camera"},
                                         TopLevelArray{"meshes", "mesh"},
                                         TopLevelArray{"materials", "material"},
                                         TopLevelArray{"textures", "texture"},
                                         TopLevelArray{"images", "image"},
                                         TopLevelArray{"samplers", "sampler"},
                                         TopLevelArray{"skins", "skin"},
                                         TopLevelArray{"animations", "animation"},
                                         TopLevelArray{"accessors", "accessor"},
                                         TopLevelArray{"bufferViews", "buffer view"},
                                         TopLevelArray{"buffers", "buffer"}};

const json* member(const json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

bool has(const json& object, const char* key) {
    return member(object, key) != nullptr;
}

bool metallic_roughness_has(const json& material, const char* key) {
    const json* pbr = member(material, "pbrMetallicRoughness");
    return pbr != nullptr && has(*pbr, key);
}

bool text_is(const json& object, const char* key, const char* value) {
    const json* text = member(object, key);
    return text != nullptr && *text == value;
}

template <typename Test>
bool any_primitive(const json& mesh, const Test& test) {
    const json* primitives = member(mesh, "primitives");
    return primitives != nullptr && std::any_of(primitives->begin(), primitives->end(), test);
}

bool has_mode(const json& mesh, int low, int high) {
    return any_primitive(mesh, [&](const json& primitive) {
        const json* mode = member(primitive, "mode");
        return mode != nullptr && *mode >= low && *mode <= high;
    });
}

bool has_attribute(const json& mesh, const char* name) {
    return any_primitive(mesh, [&](const json& primitive) {
        const json* attributes = member(primitive, "attributes");
        return attributes != nullptr && has(*attributes, name);
    });
}

constexpr Verdict honoured = Verdict::honoured;
constexpr Verdict ignored = Verdict::ignored;

constexpr std::array feature_entries = {
    FeatureEntry{"nodes", "skin", honoured, "", [](const json& node) { return has(node, "skin"); }},
    FeatureEntry{"cameras", "camera", honoured, "", [](const json&) { return true; }},
    FeatureEntry{"meshes",
                 "points",
                 honoured,
                 "as spheres, --point-size across; lit where they have normals",
                 [](const json& mesh) { return has_mode(mesh, 0, 0); }},
    FeatureEntry{"meshes",
                 "lines",
                 honoured,
                 "as round curves, --line-width across; lit where they have normals",
                 [](const json& mesh) { return has_mode(mesh, 1, 3); }},
    FeatureEntry{"meshes",
                 "morph targets",
                 honoured,
                 "",
                 [](const json& mesh) {
                     return any_primitive(mesh, [](const json& p) { return has(p, "targets"); });
                 }},
    FeatureEntry{"meshes",
                 "COLOR_0",
                 honoured,
                 "it multiplies the base colour",
                 [](const json& mesh) { return has_attribute(mesh, "COLOR_0"); }},
    FeatureEntry{"materials",
                 "baseColorTexture",
                 honoured,
                 "",
                 [](const json& m) { return metallic_roughness_has(m, "baseColorTexture"); }},
    FeatureEntry{
        "materials",
        "metallicRoughnessTexture",
        honoured,
        "",
        [](const json& m) { return metallic_roughness_has(m, "metallicRoughnessTexture"); }},
    FeatureEntry{"materials",
                 "normalTexture",
                 honoured,
                 "",
                 [](const json& m) { return has(m, "normalTexture"); }},
    FeatureEntry{"materials",
                 "emissiveTexture",
                 honoured,
                 "",
                 [](const json& m) { return has(m, "emissiveTexture"); }},
    FeatureEntry{
        "materials",
        "occlusionTexture",
        ignored,
        "what it guesses is traced: light that nearby geometry blocks; --occlusion ambient "
        "applies it",
        [](const json& m) { return has(m, "occlusionTexture"); }},
    FeatureEntry{"materials",
                 "alphaMode MASK",
                 honoured,
                 "",
                 [](const json& m) { return text_is(m, "alphaMode", "MASK"); }},
    FeatureEntry{"materials",
                 "alphaMode BLEND",
                 honoured,
                 "coverage: a ray meets the surface with the probability of its alpha",
                 [](const json& m) { return text_is(m, "alphaMode", "BLEND"); }},
    FeatureEntry{"animations",
                 "animation",
                 honoured,
                 "played by --time and --frames, chosen by --animation",
                 [](const json&) { return true; }},
    FeatureEntry{"accessors",
                 "sparse",
                 honoured,
                 "",
                 [](const json& accessor) { return has(accessor, "sparse"); }},
};

/// "material 3 Glass".
std::string place_name(const json& part, const char* kind, size_t index) {
    std::string out = std::string(kind) + " " + std::to_string(index);
    const json* name = member(part, "name");
    if (name == nullptr || !name->is_string()) return out;
    const std::string& text = name->get_ref<const std::string&>();
    if (!text.empty()) out += " " + text;
    return out;
}

ReportEntry extension_report(const std::string& place, const std::string& name) {
    const ExtensionEntry* entry = find_extension(name);
    if (entry == nullptr) return {place, name, Verdict::ignored, "it is not known"};
    const bool works = entry->supported;
    return {place,
            name,
            works ? entry->verdict : Verdict::ignored,
            std::string(works ? entry->note : entry->without)};
}

void report_array(const json& parts, const TopLevelArray& kind, std::vector<ReportEntry>& out) {
    for (size_t index = 0; index < parts.size(); ++index) {
        const json& part = parts[index];
        const auto place = [&] { return place_name(part, kind.name, index); };
        for (const FeatureEntry& entry : feature_entries) {
            if (entry.array != kind.array || !entry.is_used(part)) continue;
            out.push_back(
                {place(), std::string(entry.name), entry.verdict, std::string(entry.note)});
        }
        for (const std::string& name : extension_names(part))
            out.push_back(extension_report(place(), name));
    }
}

}  // namespace

std::span<const FeatureEntry> feature_table() {
    return feature_entries;
}

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::honoured:
            return "honoured";
        case Verdict::approximated:
            return "approximated";
        case Verdict::ignored:
            return "ignored";
    }
    return {};
}

std::vector<ReportEntry> make_report(const json& tree) {
    std::vector<ReportEntry> parts;
    for (const TopLevelArray& kind : top_level_arrays) {
        const json* array = member(tree, kind.array);
        if (array != nullptr && array->is_array()) report_array(*array, kind, parts);
    }
    // What the asset says as a whole, and what it uses without saying where.
    std::vector<std::string> whole;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const json* names = member(tree, list);
        if (names == nullptr) continue;
        for (const json& name : *names) {
            const auto is_it = [&](const ReportEntry& entry) { return name == entry.feature; };
            if (std::none_of(parts.begin(), parts.end(), is_it)) {
                whole.push_back(name.get<std::string>());
            }
        }
    }
    for (const char* key : {"extensions", "asset"}) {
        const json* object = member(tree, key);
        if (object == nullptr) continue;
        const json wrapped = {{key, *object}};
        for (const std::string& name : extension_names(wrapped))
            whole.push_back(name);
    }
    std::sort(whole.begin(), whole.end());
    whole.erase(std::unique(whole.begin(), whole.end()), whole.end());
    std::vector<ReportEntry> out;
    for (const std::string& name : whole)
        out.push_back(extension_report("asset", name));
    out.insert(out.end(), parts.begin(), parts.end());
    return out;
}

}  // namespace obscura::gltf
