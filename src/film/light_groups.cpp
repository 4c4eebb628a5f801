// film/light_groups.cpp - which lights of a scene belong to which light group.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_groups.h"

#include "base/name_search.h"
#include "base/text.h"
#include "film/cryptomatte_names.h"
#include "film/layers.h"

#include <algorithm>
#include <set>

namespace obscura {

namespace {

constexpr const char* environment_name = "env";
constexpr const char* rest_name = "rest";

/// The names that one light, node or material has.
using Names = std::vector<std::string>;

/// Names of a node and of those above it, with their paths.
std::vector<Names> names_of_nodes(const AssetInfo& info) {
    const std::vector<std::string> paths = node_paths(info);
    std::vector<Names> out(paths.size());
    for (size_t node = 0; node < out.size(); ++node) {
        for (auto at = static_cast<int32_t>(node); at >= 0;
             at = info.node_parents[static_cast<size_t>(at)]) {
            out[node].push_back(info.node_names[static_cast<size_t>(at)]);
            out[node].push_back(paths[static_cast<size_t>(at)]);
        }
    }
    return out;
}

/// The names of everything that patterns are compared with.
struct NamedLights {
    std::vector<Names> lights, nodes, materials;
};

NamedLights names_in(const Scene& scene) {
    NamedLights out;
    out.nodes = names_of_nodes(scene.info);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        Names names;
        if (i < scene.info.light_nodes.size()) {
            const int32_t node = scene.info.light_nodes[i];
            if (node >= 0) names = out.nodes[static_cast<size_t>(node)];
        }
        if (i < scene.info.light_names.size()) names.push_back(scene.info.light_names[i]);
        out.lights.push_back(std::move(names));
    }
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const bool named = i < scene.material_names.size() && !scene.material_names[i].empty();
        out.materials.push_back(named ? Names{scene.material_names[i]} : Names{});
    }
    return out;
}

bool emits(const Material& material) {
    return std::any_of(std::begin(material.emission),
                       std::end(material.emission),
                       [](float channel) { return channel > 0; });
}

/// For a message about a pattern that fits nothing: a name near to it, else those of lights.
std::string names_of_lights(const Scene& scene, const std::string& pattern) {
    Names all = scene.info.light_names;
    all.insert(all.end(), scene.material_names.begin(), scene.material_names.end());
    all.insert(all.end(), scene.info.node_names.begin(), scene.info.node_names.end());
    if (std::string near = near_names(pattern, all); !near.empty()) return near;
    Names lights = scene.info.light_names;
    for (size_t i = 0; i < std::min(scene.material_names.size(), scene.materials.size()); ++i) {
        const Material& material = scene.materials[i];
        if (emits(material) || (material.flags & material_unlit) != 0)
            lights.push_back(scene.material_names[i]);
    }
    std::erase(lights, "");
    lights.emplace_back(environment_name);
    return names_instead(pattern, lights, "lights");
}

bool fits_one(const std::string& pattern, const Names& names) {
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        return fits_pattern(pattern, name);
    });
}

/// Puts what fits the pattern and is in no group yet into the group. True when something fits.
bool take(const std::string& pattern,
          const std::vector<Names>& names,
          uint16_t group,
          std::vector<uint16_t>& groups) {
    bool found = false;
    for (size_t i = 0; i < names.size(); ++i) {
        if (!fits_one(pattern, names[i])) continue;
        found = true;
        groups[i] = std::min(groups[i], group);
    }
    return found;
}

Result<void> check_names(const LightGroupOptions& options) {
    std::set<std::string> names = {rest_name};
    for (const LightGroupPattern& group : options.groups) {
        if (names.insert(group.name).second) continue;
        return fail(ExitCode::usage,
                    "E-LIGHT-GROUP",
                    group.name,
                    group.name == rest_name ? "this group holds what fits no other; choose another "
                                              "name"
                                            : "two light groups have this name; give each its own");
    }
    return {};
}

Result<LightGroups> too_many(size_t count) {
    return fail(ExitCode::usage,
                "E-LIGHT-GROUP",
                "light groups",
                std::to_string(count) + " are asked for; at most " +
                    std::to_string(max_light_groups) + " are accepted");
}

Result<LightGroups> groups_by_pattern(const Scene& scene, const LightGroupOptions& options) {
    const Result<void> checked = check_names(options);
    if (!checked) return fail(checked.error());
    const NamedLights names = names_in(scene);
    LightGroups out;
    out.names = names_of_groups(options);
    const uint16_t rest = out.rest();
    out.of_light.assign(names.lights.size(), rest);
    out.of_node.assign(names.nodes.size(), rest);
    out.of_material.assign(names.materials.size(), rest);
    out.environment = rest;
    for (uint16_t group = 0; group < rest; ++group) {
        for (const std::string& pattern : options.groups[group].patterns) {
            bool found = take(pattern, names.lights, group, out.of_light);
            found |= take(pattern, names.nodes, group, out.of_node);
            found |= take(pattern, names.materials, group, out.of_material);
            if (fits_pattern(pattern, environment_name)) {
                found = true;
                out.environment = std::min(out.environment, group);
            }
            if (found) continue;
            return fail(ExitCode::usage,
                        "E-LIGHT-GROUP-UNKNOWN",
                        out.names[group],
                        "no light, node or material fits " + in_quotes(pattern) +
                            names_of_lights(scene, pattern));
        }
    }
    return out;
}

/// Makes a name fit for channels, and unlike all before it.
std::string unique_name(std::string name, std::set<std::string>& taken) {
    for (char& c : name) {
        if (!is_layer_name({&c, 1})) c = '_';
    }
    if (name.empty()) name = "light";
    std::string unique = name;
    for (int number = 2; !taken.insert(unique).second; ++number)
        unique = name + "_" + std::to_string(number);
    return unique;
}

Result<LightGroups> groups_of_each(const Scene& scene) {
    LightGroups out;
    std::set<std::string> taken = {environment_name, rest_name};
    const auto next = [&](const std::vector<std::string>& names, size_t i, const char* kind) {
        const bool named = i < names.size() && !names[i].empty();
        out.names.push_back(unique_name(named ? names[i] : kind + std::to_string(i), taken));
        return static_cast<uint16_t>(out.names.size() - 1);
    };
    const auto glowing =
        static_cast<size_t>(std::count_if(scene.materials.begin(), scene.materials.end(), emits));
    const size_t count = scene.lights.size() + glowing + 2;
    if (count > max_light_groups) return too_many(count);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        out.of_light.push_back(next(scene.info.light_names, i, "light_"));
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        out.of_material.push_back(
            emits(scene.materials[i]) ? next(scene.material_names, i, "material_") : UINT16_MAX);
    }
    out.environment = static_cast<uint16_t>(out.names.size());
    out.names.emplace_back(environment_name);
    out.names.emplace_back(rest_name);
    for (uint16_t& group : out.of_material)
        group = std::min(group, out.rest());
    out.of_node.assign(scene.info.node_names.size(), out.rest());
    return out;
}

}  // namespace

Result<LightGroupPattern> parse_light_group(const std::string& text) {
    const size_t equals = text.find('=');
    LightGroupPattern group{text.substr(0, equals), {}};
    if (equals != std::string::npos) {
        for (size_t begin = equals + 1; begin <= text.size();) {
            const size_t end = std::min(text.find(',', begin), text.size());
            if (end > begin) group.patterns.push_back(text.substr(begin, end - begin));
            begin = end + 1;
        }
    }
    if (!is_layer_name(group.name) || group.patterns.empty()) {
        return fail(ExitCode::usage,
                    "E-LIGHT-GROUP",
                    text,
                    "expected NAME=PATTERN or NAME=PATTERN,PATTERN such as key=Key*,Sun, with a "
                    "name of letters, digits, - and _");
    }
    return group;
}

std::vector<std::string> names_of_groups(const LightGroupOptions& options) {
    std::vector<std::string> names;
    for (const LightGroupPattern& group : options.groups)
        names.push_back(group.name);
    names.emplace_back(rest_name);
    return names;
}

Result<LightGroups> make_light_groups(const Scene& scene, const LightGroupOptions& options) {
    if (options.each) return groups_of_each(scene);
    if (options.groups.size() >= max_light_groups) return too_many(options.groups.size() + 1);
    return groups_by_pattern(scene, options);
}

}  // namespace obscura
