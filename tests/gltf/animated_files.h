// tests/gltf/animated_files.h - small animated glTF assets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/gltf_files.h"

#include <string>
#include <vector>

namespace obscura::gltf::test {

/// Values over time, and what they change.
struct Movement {
    json target;  ///< of the channel
    std::vector<float> times;
    const char* type = "VEC3";
    std::vector<float> values;
    const char* interpolation = "LINEAR";
};

inline json node_target(int node, const char* path) {
    return {{"node", node}, {"path", path}};
}

inline json pointer_target(const char* pointer) {
    return {{"path", "pointer"},
            {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

/// Adds an animation of one channel each.
inline void add_animation(AssetBuilder& builder,
                          const char* name,
                          const std::vector<Movement>& movements) {
    json animation = {{"name", name}, {"samplers", json::array()}, {"channels", json::array()}};
    for (const Movement& movement : movements) {
        const int input = builder.add_accessor("SCALAR", 5126, movement.times);
        const int output = builder.add_accessor(movement.type, 5126, movement.values);
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", movement.target}});
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", movement.interpolation}});
    }
    builder.tree["animations"].push_back(animation);
}

/// The asset at a time; `choice` is --animation, nullptr: not given.
inline Loaded load_at(const json& tree, double time_s, const char* choice = nullptr) {
    LoadOptions options;
    options.time_s = time_s;
    if (choice != nullptr) options.animation = choice;
    return load_tree(tree, options);
}

}  // namespace obscura::gltf::test
