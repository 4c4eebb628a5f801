// gltf/parse/animation_pointer.h - resolves and writes what KHR_animation_pointer names.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura::gltf {

/// One property of the glTF 2.0 Asset Object Model.
struct PointedProperty {
    AnimatedProperty property;
    size_t width = 1;    ///< numbers in a value; 0: as many as there are weights
    bool in_use = true;  ///< false: known, but an image does not show it
};

/// Finds the property that a JSON pointer names in a document whose animations are not read yet;
/// nothing when it cannot be animated. Elements of arrays, such as
/// /materials/0/pbrMetallicRoughness/baseColorFactor/3, are properties of their own. The file may
/// omit properties with a default, and extensions or a pbrMetallicRoughness that would hold nothing
/// else; a texture, a lens' number or a cone must exist.
///
/// Source  Khronos, "glTF 2.0 Asset Object Model Specification"; KHR_animation_pointer, which
///         speaks of channels that target "individual elements" of an array
std::optional<PointedProperty> find_property(const Document& document, const std::string& pointer);

/// All pointers that can be animated, but for those to elements; * stands for an index, and
/// TEXTURE for the path of any texture.
std::vector<std::string> property_patterns();

/// Writes a value, except weights and visibility, into the document: numbers of materials into
/// Document::material_factors, from which finish_materials then makes materials. Values are clamped
/// to their range, as when they are read.
///
/// In      value: PointedProperty::width numbers
/// Errors  65 E-CAM-VALUE a number of OBSCURA_camera out of its range
Result<void> set_property(const AnimatedProperty& property,
                          std::span<const double> value,
                          Document& document);

}  // namespace obscura::gltf
