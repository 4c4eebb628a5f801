// gltf/parse/tree_rules.h - the members of glTF's objects: their types and what they point to.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace obscura::gltf {

/// The arrays that indices point into.
enum class TreeArray {
    none,
    buffers,
    views,
    accessors,
    images,
    samplers,
    textures,
    materials,
    meshes,
    skins,
    cameras,
    nodes,
    scenes
};

struct TreeArrayName {
    const char* key;
    const char* what;  ///< for messages: there is no "buffer view" 5
};

/// By TreeArray.
inline constexpr std::array<TreeArrayName, 13> tree_array_names = {{{"", ""},
                                                                    {"buffers", "buffer"},
                                                                    {"bufferViews", "buffer view"},
                                                                    {"accessors", "accessor"},
                                                                    {"images", "image"},
                                                                    {"samplers", "sampler"},
                                                                    {"textures", "texture"},
                                                                    {"materials", "material"},
                                                                    {"meshes", "mesh"},
                                                                    {"skins", "skin"},
                                                                    {"cameras", "camera"},
                                                                    {"nodes", "node"},
                                                                    {"scenes", "scene"}}};

enum class MemberType {
    text,
    number,
    boolean,
    size,     ///< an integer from 0 to 2^53
    count,    ///< the same; what is more than 2^31 - 1 becomes that
    numbers,  ///< `width` of them
    index,    ///< into `array`
    indices,
    index_map,  ///< an object of indices
    object,     ///< by `rules`
    objects,    ///< an array of them
    index_maps
};

struct ObjectRules;

struct MemberRule {
    std::string_view key;
    MemberType type;
    bool required = false;
    TreeArray array = TreeArray::none;
    size_t width = 0;
    const ObjectRules* rules = nullptr;
};

/// To read one more member of glTF's own: its entry in tree_rules.cpp. To read an extension: its
/// name with the object that has it.
struct ObjectRules {
    std::span<const MemberRule> members;
    std::span<const std::string_view> extensions = {};  ///< that are read; the others are taken out
    /// The member "extensions" must be an object, whatever is in it.
    bool has_extensions = false;
};

extern const ObjectRules buffer_rules;
extern const ObjectRules view_rules;
extern const ObjectRules accessor_rules;
extern const ObjectRules image_rules;
extern const ObjectRules sampler_rules;
extern const ObjectRules texture_rules;
extern const ObjectRules occlusion_rules;
extern const ObjectRules material_rules;
extern const ObjectRules mesh_rules;
extern const ObjectRules skin_rules;
extern const ObjectRules camera_rules;
extern const ObjectRules perspective_rules;
extern const ObjectRules orthographic_rules;
extern const ObjectRules light_rules;
extern const ObjectRules spot_rules;
extern const ObjectRules node_rules;
extern const ObjectRules animation_rules;
extern const ObjectRules channel_target_rules;
extern const ObjectRules scene_rules;
extern const ObjectRules root_rules;  ///< what is no array, and the asset's own extensions

}  // namespace obscura::gltf
