// stages/aov.h - the closed list of AOVs: what a sample's first surface hit tells besides light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/layer_kind.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace obscura {

/// How the samples of a pixel become one value.
enum class Reduction {
    mean,    ///< over all samples; those that hit nothing count as 0
    nearest  ///< the sample whose hit is nearest to the camera; 0 where nothing was hit
};

/// To add one: append it here and to aov_entries, give it its formula in stages/3_aov.cpp, and test
/// it in tests/render/aov_test.cpp.
enum class Aov : int {
    depth,
    distance,
    position,
    normal,
    normal_geometric,
    tangent,
    uv,
    facing,
    base_color,
    albedo,
    roughness,
    metallic,
    emission_color,
    opacity,
    motion,
    id_node,
    id_material,
    id_triangle,
    instance
};

struct AovEntry {
    Aov aov;
    const char* name;  ///< of the layer, for --aov
    std::string_view
        letters;  ///< one for each channel: "XYZ" of "normal.X", "normal.Y", "normal.Z"
    LayerKind kind;
    Reduction reduction;
    const char* help;
};

/// In the order of the enumeration.
inline constexpr std::array aov_entries = {
    AovEntry{Aov::depth,
             "depth",
             "Z",
             LayerKind::data,
             Reduction::nearest,
             "metres along the view axis"},
    AovEntry{
        Aov::distance, "distance", "Z", LayerKind::data, Reduction::nearest, "metres from the eye"},
    AovEntry{Aov::position,
             "position",
             "XYZ",
             LayerKind::data,
             Reduction::nearest,
             "in the world, metres"},
    AovEntry{Aov::normal,
             "normal",
             "XYZ",
             LayerKind::data,
             Reduction::mean,
             "shading normal in the world, with the normal map, on the viewer's side"},
    AovEntry{Aov::normal_geometric,
             "normal_geometric",
             "XYZ",
             LayerKind::data,
             Reduction::mean,
             "normal of the face in the world, on the viewer's side"},
    AovEntry{Aov::tangent,
             "tangent",
             "XYZ",
             LayerKind::data,
             Reduction::mean,
             "in the world, along growing U; 0 where a material needs none"},
    AovEntry{Aov::uv,
             "uv",
             "UV",
             LayerKind::data,
             Reduction::nearest,
             "texture coordinates of set 0, or a shape's own; 0 where there are none"},
    AovEntry{Aov::facing,
             "facing",
             "X",
             LayerKind::data,
             Reduction::mean,
             "cosine between the shading normal and the ray"},
    AovEntry{Aov::base_color,
             "base_color",
             "RGB",
             LayerKind::color,
             Reduction::mean,
             "the material's, with texture and vertex colours"},
    AovEntry{Aov::albedo,
             "albedo",
             "RGB",
             LayerKind::color,
             Reduction::mean,
             "the share of light that the first rough surface reflects, through mirrors and glass"},
    AovEntry{Aov::roughness,
             "roughness",
             "X",
             LayerKind::data,
             Reduction::mean,
             "the material's, perceptual, in [0, 1]"},
    AovEntry{Aov::metallic,
             "metallic",
             "X",
             LayerKind::data,
             Reduction::mean,
             "the material's, in [0, 1]"},
    AovEntry{Aov::emission_color,
             "emission_color",
             "RGB",
             LayerKind::color,
             Reduction::mean,
             "radiance that the material emits towards the camera"},
    AovEntry{Aov::opacity,
             "opacity",
             "X",
             LayerKind::data,
             Reduction::mean,
             "the share of the pixel that surfaces cover"},
    AovEntry{Aov::motion,
             "motion",
             "XYZW",
             LayerKind::data,
             Reduction::nearest,
             "pixels to where the surface is seen one frame before (XY) and after (ZW)"},
    AovEntry{Aov::id_node,
             "id_node",
             "X",
             LayerKind::id,
             Reduction::nearest,
             "index of the glTF node, plus 1"},
    AovEntry{Aov::id_material,
             "id_material",
             "X",
             LayerKind::id,
             Reduction::nearest,
             "index of the glTF material, plus 1; 0 is the default one or nothing"},
    AovEntry{Aov::id_triangle,
             "id_triangle",
             "X",
             LayerKind::id,
             Reduction::nearest,
             "index of the triangle in its primitive, plus 1"},
    AovEntry{Aov::instance,
             "instance",
             "X",
             LayerKind::id,
             Reduction::nearest,
             "number of the instance in the scene, plus 1; 0: not instanced"}};

constexpr const AovEntry& entry_of(Aov aov) {
    return aov_entries[static_cast<size_t>(aov)];
}

constexpr int channel_count(Aov aov) {
    return static_cast<int>(entry_of(aov).letters.size());
}

inline constexpr int max_aov_channels = 4;

}  // namespace obscura
