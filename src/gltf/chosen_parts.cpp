// gltf/chosen_parts.cpp - which scene, nodes, meshes, materials and lights the load options name.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/chosen_parts.h"

#include "base/name_search.h"
#include "base/setting_names.h"
#include "base/text.h"
#include "gltf/geometry/primitive_modes.h"
#include "gltf/parse/node_graph.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

tl::unexpected<Error> unknown_scene(const Document& document, const std::string& asked) {
    std::string names;
    for (size_t i = 0; i < document.scenes.size(); ++i) {
        names += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + document.scenes[i].name + "\"";
    }
    return fail(ExitCode::usage,
                "E-SCENE-UNKNOWN",
                setting("scene"),
                "the asset has no scene " + asked + "; it has " + (names.empty() ? "none" : names));
}

std::vector<std::string> node_names(const Document& document) {
    std::vector<std::string> out;
    for (size_t i = 0; i < document.nodes.size(); ++i)
        out.push_back(node_label(document, static_cast<int>(i)));
    return out;
}

/// Marks the nodes that fit, and all below them; false when none fits.
bool mark_fitting(const std::string& pattern, const Document& document, std::vector<char>& marks) {
    std::vector<int> open;
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        const int node = static_cast<int>(i);
        if (fits_pattern(pattern, node_label(document, node))) open.push_back(node);
    }
    const bool found = !open.empty();
    while (!open.empty()) {
        const auto node = static_cast<size_t>(open.back());
        open.pop_back();
        if (marks[node] != 0) continue;
        marks[node] = 1;
        const std::vector<int>& children = document.nodes[node].children;
        open.insert(open.end(), children.begin(), children.end());
    }
    return found;
}

void hide(GltfPrimitive& primitive) {
    primitive.mode = hidden_mode;
}

/// Hides the primitives of meshes whose names fit; false when there is none.
bool hide_meshes(const std::string& pattern, Document& document) {
    bool found = false;
    for (GltfMesh& mesh : document.meshes) {
        if (mesh.name.empty() || !fits_pattern(pattern, mesh.name)) continue;
        found = true;
        for (GltfPrimitive& primitive : mesh.primitives)
            hide(primitive);
    }
    return found;
}

/// Hides what has the materials whose names fit; false when there is none.
bool hide_materials(const std::string& pattern, Document& document) {
    bool found = false;
    std::vector<char> hidden(document.materials.size(), 0);
    for (size_t i = 0; i < hidden.size(); ++i) {
        const std::string& name = document.materials[i].name;
        if (name.empty() || !fits_pattern(pattern, name)) continue;
        found = true;
        hidden[i] = 1;
    }
    const auto is_hidden = [&](int material) {
        return material >= 0 && hidden[static_cast<size_t>(material)] != 0;
    };
    for (GltfMesh& mesh : document.meshes) {
        for (GltfPrimitive& primitive : mesh.primitives) {
            if (is_hidden(primitive.material)) hide(primitive);
        }
    }
    for (GltfNode& node : document.nodes) {
        if (node.shape >= 0 && is_hidden(node.shape_material)) node.shape = -1;
    }
    return found;
}

/// The option whose rules set a flag.
const char* option_of(uint8_t flag) {
    switch (flag) {
        case visibility_holdout:
            return "holdout";
        case visibility_no_camera:
            return "camera-invisible";
        case visibility_no_shadow:
            return "no-shadow";
        default:
            return "catcher";
    }
}

/// An error for a pattern that fits no node, mesh or material.
tl::unexpected<Error> unknown_part(const char* id,
                                   const char* option,
                                   const std::string& pattern,
                                   const Document& document) {
    std::vector<std::string> names = node_names(document);
    for (const GltfMesh& mesh : document.meshes)
        names.push_back(mesh.name);
    for (const GltfMaterial& material : document.materials)
        names.push_back(material.name);
    std::erase(names, "");
    return fail(ExitCode::usage,
                id,
                setting(option),
                "no node, mesh or material is called " + in_quotes(pattern) +
                    names_instead(pattern, names, "names"));
}

/// Calls visit(light's name, node's label) for every light of every node.
template <typename Visit>
void each_light(const Document& document, const Visit& visit) {
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        const GltfNode& node = document.nodes[i];
        const std::string label = node_label(document, static_cast<int>(i));
        if (node.light >= 0) visit(document.lights[static_cast<size_t>(node.light)].name, label);
        if (node.ies.profile >= 0)
            visit(document.profiles[static_cast<size_t>(node.ies.profile)].name, label);
    }
}

}  // namespace

Result<int> choose_scene(const Document& document, const LoadOptions& options, Log& log) {
    const int count = static_cast<int>(document.scenes.size());
    if (options.scene >= 0) {
        if (options.scene >= count) return unknown_scene(document, std::to_string(options.scene));
        return options.scene;
    }
    if (!options.scene_name.empty()) {
        for (int i = 0; i < count; ++i) {
            if (document.scenes[static_cast<size_t>(i)].name == options.scene_name) return i;
        }
        return unknown_scene(document, "\"" + options.scene_name + "\"");
    }
    if (count == 0) {
        log.warn(document.file, "the asset has no scene; all its root nodes are drawn");
        return -1;
    }
    return std::max(document.scene, 0);
}

Result<std::vector<char>> find_subtree(const std::string& pattern, const Document& document) {
    std::vector<char> marks(document.nodes.size(), 0);
    if (mark_fitting(pattern, document, marks)) return marks;
    return fail(ExitCode::usage,
                "E-NODE-UNKNOWN",
                setting("focus-node"),
                "no node is called " + in_quotes(pattern) +
                    names_instead(pattern, node_names(document), "nodes"));
}

Result<std::vector<char>> hide_parts(const std::vector<std::string>& patterns, Document& document) {
    if (patterns.empty()) return std::vector<char>{};
    std::vector<char> nodes(document.nodes.size(), 0);
    for (const std::string& pattern : patterns) {
        const bool is_node = mark_fitting(pattern, document, nodes);
        const bool is_mesh = hide_meshes(pattern, document);
        const bool is_material = hide_materials(pattern, document);
        if (is_node || is_mesh || is_material) continue;
        return unknown_part("E-HIDE-UNKNOWN", "hide", pattern, document);
    }
    return nodes;
}

Result<VisibilityMarks> mark_visibility(const std::vector<VisibilityRule>& rules,
                                        const Document& document) {
    VisibilityMarks out;
    if (rules.empty()) return out;
    out.nodes.resize(document.nodes.size(), 0);
    out.materials.resize(document.materials.size(), 0);
    for (const auto& [pattern, flag] : rules) {
        std::vector<char> fits(document.nodes.size(), 0);
        bool found = mark_fitting(pattern, document, fits);
        for (size_t i = 0; i < fits.size(); ++i) {
            const int mesh = document.nodes[i].mesh;
            const std::string name =
                mesh < 0 ? "" : document.meshes[static_cast<size_t>(mesh)].name;
            if (!name.empty() && fits_pattern(pattern, name)) fits[i] = 1;
            if (fits[i] == 0) continue;
            found = true;
            out.nodes[i] |= flag;
        }
        for (size_t i = 0; i < out.materials.size(); ++i) {
            const std::string& name = document.materials[i].name;
            if (name.empty() || !fits_pattern(pattern, name)) continue;
            found = true;
            out.materials[i] |= flag;
        }
        if (!found) {
            return unknown_part("E-VISIBILITY-UNKNOWN", option_of(flag), pattern, document);
        }
    }
    return out;
}

void set_visibility(const VisibilityMarks& marks, Scene& scene) {
    scene.visibility = {};
    if (marks.nodes.empty()) return;
    const auto of_node = [&](int32_t node) {
        return node < 0 ? uint8_t{0} : marks.nodes[static_cast<size_t>(node)];
    };
    for (const Primitive& primitive : scene.primitives) {
        const int32_t material = scene.material_numbers[static_cast<size_t>(primitive.material)];
        const uint8_t own =
            material < 0 ? uint8_t{0} : marks.materials[static_cast<size_t>(material)];
        scene.visibility.primitives.push_back(static_cast<uint8_t>(own | of_node(primitive.node)));
    }
    for (const Instance& instance : scene.instances)
        scene.visibility.instances.push_back(of_node(instance.node));
}

Result<void> check_light_choice(const LightChoice& choice, const Document& document) {
    for (const LightChoice::Factor& factor : choice.factors) {
        bool found = false;
        std::vector<std::string> names;
        each_light(document, [&](const std::string& light, const std::string& node) {
            found =
                found || fits_pattern(factor.pattern, light) || fits_pattern(factor.pattern, node);
            names.push_back(light);
            names.push_back(node);
        });
        if (found) continue;
        return fail(ExitCode::usage,
                    "E-LIGHT-UNKNOWN",
                    setting("lights"),
                    "no light and no light's node is called " + in_quotes(factor.pattern) +
                        names_instead(factor.pattern, names, "lights and their nodes"));
    }
    return {};
}

double light_factor(const LightChoice& choice, const std::string& light, const std::string& node) {
    if (choice.off) return 0;
    double out = 1;
    for (const LightChoice::Factor& factor : choice.factors) {
        if (fits_pattern(factor.pattern, light) || fits_pattern(factor.pattern, node))
            out = factor.factor;
    }
    return out;
}

}  // namespace obscura::gltf
