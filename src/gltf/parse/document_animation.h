// gltf/parse/document_animation.h - skins and animations as plain structs: every index checked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace obscura::gltf {

/// A node's transform in parts; the quaternion (x, y, z, w) is unit.
struct GltfTrs {
    std::array<double, 3> translation = {0, 0, 0};
    std::array<double, 4> rotation = {0, 0, 0, 1};
    std::array<double, 3> scale = {1, 1, 1};
};

struct GltfSkin {
    std::string name;
    std::vector<int> joints;         ///< nodes
    int inverse_bind_matrices = -1;  ///< accessor; -1: identities
};

enum class Interpolation { step, linear, cubic_spline };

struct GltfAnimationSampler {
    int input = 0;   ///< accessor of times
    int output = 0;  ///< accessor of values
    Interpolation interpolation = Interpolation::linear;
};

/// What a channel changes. profile_*: EXT_lights_ies of a node; environment_*: a light of
/// EXT_lights_image_based; lens and blades: OBSCURA_camera.
enum class ChannelPath {
    translation,
    rotation,
    scale,
    weights,
    mesh_weights,
    visible,
    profile,
    environment,
    environment_rotation,
    material,
    texture_transform,
    light,
    camera,
    lens,
    blades
};

inline bool moves_node(ChannelPath path) {
    return path == ChannelPath::translation || path == ChannelPath::rotation ||
           path == ChannelPath::scale;
}

/// What a channel changes and where it lies in a Document.
struct AnimatedProperty {
    ChannelPath path = ChannelPath::translation;
    int target = -1;   ///< number of the node, mesh, material, light or camera
    int element = -1;  ///< the one number of a list, or the one weight, that changes; -1: all
    int entry = -1;    ///< in the table of numbers that the path's objects have
    int texture = -1;  ///< of texture_transform: entry of the texture in material_entries

    bool operator==(const AnimatedProperty&) const = default;
};

/// True for rotations, which follow the shortest arc.
inline bool is_quaternion(const AnimatedProperty& property) {
    return property.element < 0 && (property.path == ChannelPath::rotation ||
                                    property.path == ChannelPath::environment_rotation);
}

struct GltfChannel {
    int sampler = 0;
    AnimatedProperty property;
    size_t width = 1;  ///< numbers in a value
};

struct GltfAnimation {
    std::string name;
    std::vector<GltfAnimationSampler> samplers;
    std::vector<GltfChannel> channels;  ///< those that can be played
};

}  // namespace obscura::gltf
