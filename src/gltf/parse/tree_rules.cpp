// gltf/parse/tree_rules.cpp - the members of glTF's objects: their types and what they point to.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/tree_rules.h"

namespace obscura::gltf {

namespace {

using enum MemberType;

constexpr bool needed = true;

constexpr MemberRule index_into(std::string_view key, TreeArray array, bool required = false) {
    return {.key = key, .type = index, .required = required, .array = array};
}
constexpr MemberRule indices_into(std::string_view key, TreeArray array, bool required = false) {
    return {.key = key, .type = indices, .required = required, .array = array};
}
constexpr MemberRule numbers_of(std::string_view key, size_t width) {
    return {.key = key, .type = numbers, .width = width};
}
constexpr MemberRule object_by(std::string_view key, const ObjectRules& rules) {
    return {.key = key, .type = object, .rules = &rules};
}
constexpr MemberRule objects_by(std::string_view key,
                                const ObjectRules& rules,
                                bool required = false) {
    return {.key = key, .type = objects, .required = required, .rules = &rules};
}

constexpr MemberRule buffer_members[] = {
    {"byteLength", size, needed}, {"name", text}, {"uri", text}};

constexpr MemberRule view_members[] = {index_into("buffer", TreeArray::buffers, needed),
                                       {"byteLength", size, needed},
                                       {"byteOffset", size},
                                       {"byteStride", size}};
constexpr std::string_view view_extensions[] = {"KHR_meshopt_compression",
                                                "EXT_meshopt_compression"};

constexpr MemberRule sparse_index_members[] = {index_into("bufferView", TreeArray::views, needed),
                                               {"componentType", count, needed},
                                               {"byteOffset", count}};
constexpr ObjectRules sparse_index_rules = {sparse_index_members};
constexpr MemberRule sparse_value_members[] = {index_into("bufferView", TreeArray::views, needed),
                                               {"byteOffset", count}};
constexpr ObjectRules sparse_value_rules = {sparse_value_members};
constexpr MemberRule sparse_members[] = {{"count", count, needed},
                                         object_by("indices", sparse_index_rules),
                                         object_by("values", sparse_value_rules)};
constexpr ObjectRules sparse_rules = {sparse_members};
constexpr MemberRule accessor_members[] = {{"componentType", count, needed},
                                           {"count", size, needed},
                                           {"type", text, needed},
                                           index_into("bufferView", TreeArray::views),
                                           {"byteOffset", size},
                                           {"normalized", boolean},
                                           object_by("sparse", sparse_rules)};

constexpr MemberRule image_members[] = {
    {"name", text}, {"uri", text}, index_into("bufferView", TreeArray::views), {"mimeType", text}};

constexpr MemberRule sampler_members[] = {
    {"magFilter", count}, {"minFilter", count}, {"wrapS", count}, {"wrapT", count}};

constexpr MemberRule texture_members[] = {index_into("sampler", TreeArray::samplers),
                                          index_into("source", TreeArray::images)};
constexpr std::string_view texture_extensions[] = {"EXT_texture_webp", "KHR_texture_basisu"};

// Normal and occlusion textures have one number more than others, which others ignore.
constexpr std::string_view texture_info_extensions[] = {"KHR_texture_transform"};
constexpr MemberRule texture_info_members[] = {index_into("index", TreeArray::textures, needed),
                                               {"texCoord", count}};
constexpr ObjectRules texture_info_rules = {texture_info_members, texture_info_extensions, true};
constexpr MemberRule normal_members[] = {
    index_into("index", TreeArray::textures, needed), {"texCoord", count}, {"scale", number}};
constexpr ObjectRules normal_rules = {normal_members, texture_info_extensions, true};
constexpr MemberRule occlusion_members[] = {
    index_into("index", TreeArray::textures, needed), {"texCoord", count}, {"strength", number}};
constexpr ObjectRules own_occlusion_rules = {occlusion_members, texture_info_extensions, true};
constexpr MemberRule metallic_roughness_members[] = {
    numbers_of("baseColorFactor", 4),
    {"metallicFactor", number},
    {"roughnessFactor", number},
    object_by("baseColorTexture", texture_info_rules),
    object_by("metallicRoughnessTexture", texture_info_rules)};
constexpr ObjectRules metallic_roughness_rules = {metallic_roughness_members};
constexpr MemberRule material_members[] = {
    {"name", text},
    object_by("pbrMetallicRoughness", metallic_roughness_rules),
    object_by("normalTexture", normal_rules),
    numbers_of("emissiveFactor", 3),
    object_by("emissiveTexture", texture_info_rules),
    object_by("occlusionTexture", own_occlusion_rules),
    {"alphaCutoff", number},
    {"alphaMode", text},
    {"doubleSided", boolean}};
constexpr std::string_view material_extensions[] = {"KHR_materials_anisotropy",
                                                    "KHR_materials_clearcoat",
                                                    "KHR_materials_diffuse_transmission",
                                                    "KHR_materials_dispersion",
                                                    "KHR_materials_emissive_strength",
                                                    "KHR_materials_ior",
                                                    "KHR_materials_iridescence",
                                                    "KHR_materials_pbrSpecularGlossiness",
                                                    "KHR_materials_sheen",
                                                    "KHR_materials_specular",
                                                    "KHR_materials_transmission",
                                                    "KHR_materials_unlit",
                                                    "KHR_materials_volume",
                                                    "KHR_materials_volume_scatter"};

constexpr MemberRule primitive_members[] = {
    {.key = "attributes", .type = index_map, .required = needed, .array = TreeArray::accessors},
    {.key = "targets", .type = index_maps, .array = TreeArray::accessors},
    index_into("indices", TreeArray::accessors),
    index_into("material", TreeArray::materials),
    {"mode", count}};
constexpr std::string_view primitive_extensions[] = {
    "KHR_gaussian_splatting", "KHR_draco_mesh_compression", "KHR_materials_variants"};
constexpr ObjectRules primitive_rules = {primitive_members, primitive_extensions, true};
constexpr MemberRule mesh_members[] = {{"name", text},
                                       objects_by("primitives", primitive_rules, needed)};

constexpr MemberRule skin_members[] = {{"name", text},
                                       indices_into("joints", TreeArray::nodes, needed),
                                       index_into("skeleton", TreeArray::nodes),
                                       index_into("inverseBindMatrices", TreeArray::accessors)};

constexpr MemberRule camera_members[] = {{"type", text, needed}, {"name", text}};
constexpr std::string_view camera_extensions[] = {"OBSCURA_camera"};
constexpr MemberRule perspective_members[] = {
    {"yfov", number, needed}, {"znear", number, needed}, {"aspectRatio", number}, {"zfar", number}};
constexpr MemberRule orthographic_members[] = {{"xmag", number, needed},
                                               {"ymag", number, needed},
                                               {"znear", number, needed},
                                               {"zfar", number, needed}};

constexpr MemberRule light_members[] = {{"name", text},
                                        {"type", text, needed},
                                        numbers_of("color", 3),
                                        {"intensity", number},
                                        {"range", number}};
constexpr MemberRule spot_members[] = {{"outerConeAngle", number}, {"innerConeAngle", number}};

constexpr MemberRule node_members[] = {{"name", text},
                                       numbers_of("translation", 3),
                                       numbers_of("rotation", 4),
                                       numbers_of("scale", 3),
                                       numbers_of("matrix", 16),
                                       index_into("mesh", TreeArray::meshes),
                                       index_into("camera", TreeArray::cameras),
                                       index_into("skin", TreeArray::skins),
                                       indices_into("children", TreeArray::nodes)};
constexpr std::string_view node_extensions[] = {"KHR_lights_punctual",
                                                "EXT_lights_ies",
                                                "KHR_node_visibility",
                                                "MSFT_lod",
                                                "EXT_mesh_gpu_instancing",
                                                "OBSCURA_shape",
                                                "KHR_implicit_shapes"};

constexpr MemberRule animation_sampler_members[] = {
    index_into("input", TreeArray::accessors, needed),
    index_into("output", TreeArray::accessors, needed),
    {"interpolation", text}};
constexpr ObjectRules animation_sampler_rules = {animation_sampler_members};
constexpr MemberRule channel_members[] = {{"sampler", count, needed}};
constexpr ObjectRules channel_rules = {channel_members};
constexpr MemberRule animation_members[] = {{"name", text},
                                            objects_by("samplers", animation_sampler_rules),
                                            objects_by("channels", channel_rules)};
constexpr MemberRule channel_target_members[] = {index_into("node", TreeArray::nodes),
                                                 {"path", text}};
constexpr std::string_view channel_target_extensions[] = {"KHR_animation_pointer"};

constexpr MemberRule scene_members[] = {{"name", text}, indices_into("nodes", TreeArray::nodes)};
constexpr std::string_view scene_extensions[] = {"EXT_lights_image_based"};

constexpr MemberRule root_members[] = {index_into("scene", TreeArray::scenes)};
constexpr std::string_view root_extensions[] = {"KHR_lights_punctual",
                                                "KHR_materials_variants",
                                                "EXT_lights_ies",
                                                "EXT_lights_image_based",
                                                "OBSCURA_shape",
                                                "KHR_implicit_shapes"};

}  // namespace

const ObjectRules buffer_rules = {buffer_members};
const ObjectRules view_rules = {view_members, view_extensions, true};
const ObjectRules accessor_rules = {accessor_members};
const ObjectRules image_rules = {image_members};
const ObjectRules sampler_rules = {sampler_members};
const ObjectRules texture_rules = {texture_members, texture_extensions, true};
const ObjectRules occlusion_rules = own_occlusion_rules;
const ObjectRules material_rules = {material_members, material_extensions, true};
const ObjectRules mesh_rules = {mesh_members};
const ObjectRules skin_rules = {skin_members};
const ObjectRules camera_rules = {camera_members, camera_extensions, true};
const ObjectRules perspective_rules = {perspective_members};
const ObjectRules orthographic_rules = {orthographic_members};
const ObjectRules light_rules = {light_members};
const ObjectRules spot_rules = {spot_members};
const ObjectRules node_rules = {node_members, node_extensions, true};
const ObjectRules animation_rules = {animation_members};
const ObjectRules channel_target_rules = {channel_target_members, channel_target_extensions, true};
const ObjectRules scene_rules = {scene_members, scene_extensions, true};
const ObjectRules root_rules = {root_members, root_extensions, true};

}  // namespace obscura::gltf
