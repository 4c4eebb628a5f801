// gltf/report.cpp - part by part, what a file asks for and what becomes of it.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/report.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

using nlohmann::json;

/// The top-level arrays and what one of their parts is called.
struct PartKind {
    const char* array;
    const char* name;
};

constexpr std::array part_kinds = {PartKind{"scenes", "scene"},
                                   PartKind{"nodes", "node"},
                                   PartKind{"cameras", "camera"},
                                   PartKind{"meshes", "mesh"},
                                   PartKind{"materials", "material"},
                                   PartKind{"textures", "texture"},
                                   PartKind{"images", "image"},
                                   PartKind{"samplers", "sampler"},
                                   PartKind{"skins", "skin"},
                                   PartKind{"animations", "animation"},
                                   PartKind{"accessors", "accessor"},
                                   PartKind{"bufferViews", "buffer view"},
                                   PartKind{"buffers", "buffer"}};

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

constexpr std::array feature_rows = {
    FeatureRow{"nodes", "skin", honoured, "", [](const json& node) { return has(node, "skin"); }},
    FeatureRow{"cameras", "camera", honoured, "", [](const json&) { return true; }},
    FeatureRow{"meshes",
               "points",
               honoured,
               "as spheres, --point-size across; lit where they have normals",
               [](const json& mesh) { return has_mode(mesh, 0, 0); }},
    FeatureRow{"meshes",
               "lines",
               honoured,
               "as round curves, --line-width across; lit where they have normals",
               [](const json& mesh) { return has_mode(mesh, 1, 3); }},
    FeatureRow{"meshes",
               "morph targets",
               honoured,
               "",
               [](const json& mesh) {
                   return any_primitive(mesh, [](const json& p) { return has(p, "targets"); });
               }},
    FeatureRow{"meshes",
               "COLOR_0",
               honoured,
               "it multiplies the base colour",
               [](const json& mesh) { return has_attribute(mesh, "COLOR_0"); }},
    FeatureRow{"materials",
               "baseColorTexture",
               honoured,
               "",
               [](const json& m) { return metallic_roughness_has(m, "baseColorTexture"); }},
    FeatureRow{"materials",
               "metallicRoughnessTexture",
               honoured,
               "",
               [](const json& m) { return metallic_roughness_has(m, "metallicRoughnessTexture"); }},
    FeatureRow{"materials",
               "normalTexture",
               honoured,
               "",
               [](const json& m) { return has(m, "normalTexture"); }},
    FeatureRow{"materials",
               "emissiveTexture",
               honoured,
               "",
               [](const json& m) { return has(m, "emissiveTexture"); }},
    FeatureRow{"materials",
               "occlusionTexture",
               ignored,
               "what it guesses is traced: light that nearby geometry blocks; --occlusion ambient "
               "applies it",
               [](const json& m) { return has(m, "occlusionTexture"); }},
    FeatureRow{"materials",
               "alphaMode MASK",
               honoured,
               "",
               [](const json& m) { return text_is(m, "alphaMode", "MASK"); }},
    FeatureRow{"materials",
               "alphaMode BLEND",
               honoured,
               "coverage: a ray meets the surface with the probability of its alpha",
               [](const json& m) { return text_is(m, "alphaMode", "BLEND"); }},
    FeatureRow{"animations",
               "animation",
               honoured,
               "played by --time and --frames, chosen by --animation",
               [](const json&) { return true; }},
    FeatureRow{"accessors",
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

ReportRow extension_report(const std::string& place, const std::string& name) {
    const ExtensionRow* row = find_extension(name);
    if (row == nullptr) return {place, name, Verdict::ignored, "it is not known"};
    const bool works = row->supported;
    return {place,
            name,
            works ? row->verdict : Verdict::ignored,
            std::string(works ? row->note : row->without)};
}

void report_array(const json& parts, const PartKind& kind, std::vector<ReportRow>& out) {
    for (size_t index = 0; index < parts.size(); ++index) {
        const json& part = parts[index];
        const auto place = [&] { return place_name(part, kind.name, index); };
        for (const FeatureRow& row : feature_rows) {
            if (row.array != kind.array || !row.is_used(part)) continue;
            out.push_back({place(), std::string(row.name), row.verdict, std::string(row.note)});
        }
        for (const std::string& name : extension_names(part))
            out.push_back(extension_report(place(), name));
    }
}

}  // namespace

std::span<const FeatureRow> feature_table() {
    return feature_rows;
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

std::vector<ReportRow> make_report(const json& tree) {
    std::vector<ReportRow> parts;
    for (const PartKind& kind : part_kinds) {
        const json* array = member(tree, kind.array);
        if (array != nullptr && array->is_array()) report_array(*array, kind, parts);
    }
    // What the asset says as a whole, and what it uses without saying where.
    std::vector<std::string> whole;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const json* names = member(tree, list);
        if (names == nullptr) continue;
        for (const json& name : *names) {
            const auto is_it = [&](const ReportRow& row) { return name == row.feature; };
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
    std::vector<ReportRow> out;
    for (const std::string& name : whole)
        out.push_back(extension_report("asset", name));
    out.insert(out.end(), parts.begin(), parts.end());
    return out;
}

}  // namespace obscura
