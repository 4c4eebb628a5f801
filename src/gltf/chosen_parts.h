// gltf/chosen_parts.h - which scene, nodes, meshes, materials and lights the load options name.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/load.h"
#include "gltf/parse/document.h"

#include <string>
#include <vector>

namespace obscura::gltf {

/// Number of the scene to load; -1 when the file has none.
///
/// Errors  64 E-SCENE-UNKNOWN
Result<int> choose_scene(const Document& document, const LoadOptions& options, Log& log);

/// Marks nodes: 1 where a node's name ("node 3" where it has none) fits the pattern, or that of a
/// node above it, by the node's number.
///
/// Errors  64 E-NODE-UNKNOWN, with the names that are near or all
Result<std::vector<char>> find_subtree(const std::string& pattern, const Document& document);

/// Makes the geometry that LoadOptions::hidden names invisible for good: meshes and materials in
/// the document itself.
///
/// Out     nodes that are not drawn, as those of find_subtree; empty: all are
/// Errors  64 E-HIDE-UNKNOWN a pattern fits no name, with those that are near or all
Result<std::vector<char>> hide_parts(const std::vector<std::string>& patterns, Document& document);

/// Flags of scene/visibility.h by the numbers of nodes and materials; empty: there are no rules.
struct VisibilityMarks {
    std::vector<uint8_t> nodes, materials;
};

/// Finds what LoadOptions::visibility names; a mesh's name stands for the nodes that show it.
///
/// Errors  64 E-VISIBILITY-UNKNOWN a pattern fits no name, with those that are near or all
Result<VisibilityMarks> mark_visibility(const std::vector<VisibilityRule>& rules,
                                        const Document& document);

/// Writes Scene::visibility, once the scene has its primitives and material numbers.
void set_visibility(const VisibilityMarks& marks, Scene& scene);

/// Checks that each pattern fits a light.
///
/// Errors  64 E-LIGHT-UNKNOWN, with the names of lights that are near or all
Result<void> check_light_choice(const LightChoice& choice, const Document& document);

/// What the choice multiplies a light's intensity by; 0: it is left out.
double light_factor(const LightChoice& choice, const std::string& light, const std::string& node);

}  // namespace obscura::gltf
