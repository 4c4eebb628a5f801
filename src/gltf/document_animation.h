// gltf/document_animation.h - skins and animations as plain structs: every index checked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace obscura {

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
/// EXT_lights_image_based. `json` is any other property that KHR_animation_pointer can name; it
/// lies in a material, a light or a camera.
enum class ChannelPath {
    translation,
    rotation,
    scale,
    weights,
    mesh_weights,
    visible,
    profile_multiplier,
    profile_color,
    environment_intensity,
    environment_rotation,
    json
};

/// Whose values turn along the shortest arc.
inline bool is_quaternion(ChannelPath path) {
    return path == ChannelPath::rotation || path == ChannelPath::environment_rotation;
}

struct GltfChannel {
    int sampler = 0;
    ChannelPath path = ChannelPath::translation;
    int target = -1;      ///< node, mesh of mesh_weights, light of environment_*
    int element = -1;     ///< the one weight that changes; -1: all
    std::string pointer;  ///< of `json`
    size_t width = 1;     ///< numbers in a value
};

struct GltfAnimation {
    std::string name;
    std::vector<GltfAnimationSampler> samplers;
    std::vector<GltfChannel> channels;  ///< those that can be played
};

}  // namespace obscura
