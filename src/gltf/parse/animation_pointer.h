// gltf/parse/animation_pointer.h - what a pointer of KHR_animation_pointer names and sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// One place of the glTF 2.0 Asset Object Model.
struct PointedProperty {
    AnimatedProperty property;
    size_t width = 1;    ///< numbers in a value; 0: as many as there are weights
    bool in_use = true;  ///< false: known, but a picture does not show it
};

/// Finds what a JSON pointer names in a document whose animations are not read yet; nothing: it
/// leads to nothing that can be animated. Elements of arrays, such as
/// /materials/0/pbrMetallicRoughness/baseColorFactor/3, are properties of their own. Properties may
/// be left out of the file where they have a default, and so may the extensions and the
/// pbrMetallicRoughness that would hold nothing else; a texture, a lens' number or a cone must
/// exist.
///
/// Source  Khronos, "glTF 2.0 Asset Object Model Specification"; KHR_animation_pointer, which
///         speaks of channels that target "individual elements" of an array
std::optional<PointedProperty> find_property(const Document& document, const std::string& pointer);

/// All pointers that can be animated, but for those to elements; * stands for an index, and
/// TEXTURE for the path of any texture.
std::vector<std::string> property_patterns();

/// Writes a value, but for weights and visibility, into the document: numbers of materials into
/// Document::material_factors, of which finish_materials then makes materials. What has a range is
/// clamped to it, as when it is read.
///
/// In      value: PointedProperty::width numbers
/// Errors  65 E-CAM-VALUE a number of OBSCURA_camera out of its range
Result<void> set_property(const AnimatedProperty& property,
                          std::span<const double> value,
                          Document& document);

}  // namespace obscura
