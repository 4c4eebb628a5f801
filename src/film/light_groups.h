// film/light_groups.h - which lights of a scene belong to which light group.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

/// A light group that is asked for: the lights that fit one of the patterns.
struct LightGroupPattern {
    std::string name;
    std::vector<std::string> patterns;
};

/// `--light-group` and the like.
struct LightGroupOptions {
    std::vector<LightGroupPattern> groups;
    bool each = false;        ///< every light, emissive material and the environment apart
    bool components = false;  ///< a layer for each group and component

    bool empty() const { return groups.empty() && !each; }
};

inline constexpr size_t max_light_groups = 256;

/// Parses "NAME=PATTERN,PATTERN".
///
/// Errors  64 E-LIGHT-GROUP
Result<LightGroupPattern> parse_light_group(const std::string& text);

/// Names of the groups that are asked for by patterns, the last one included.
std::vector<std::string> names_of_groups(const LightGroupOptions& options);

/// The groups of a scene. A light is in one group: the first one that it fits. What fits none is in
/// the last one, "rest".
struct LightGroups {
    std::vector<std::string> names;     ///< unique, in the order they were asked for
    std::vector<uint16_t> of_light;     ///< by Scene::lights
    std::vector<uint16_t> of_node;      ///< by glTF node: of what emits there
    std::vector<uint16_t> of_material;  ///< by Scene::materials
    uint16_t environment = 0;

    uint16_t rest() const { return static_cast<uint16_t>(names.size() - 1); }
};

/// Sorts the lights of a scene into groups. A pattern, in which * and ? stand for any text and
/// letter, is compared with the names of lights and of materials, and with the names and paths of
/// nodes, which stand for all below them; "env" is the environment.
///
/// Errors  64 E-LIGHT-GROUP two groups of one name, or too many; E-LIGHT-GROUP-UNKNOWN nothing fits
///         a pattern, with the names that are near
Result<LightGroups> make_light_groups(const Scene& scene, const LightGroupOptions& options);

}  // namespace obscura
