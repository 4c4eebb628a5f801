// gltf/parse/finish_material.h - makes a material's values from the numbers in the file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

namespace obscura::gltf {

/// Makes values and layers of one material. Where it is a specular-glossiness material with a
/// texture, the document gets a copy of that texture for the roughness
/// (gltf/parse/specular_glossiness.h).
///
/// In      factors: their textures are those of the document
/// Out     colours in the rendering space (Document::from_rec709)
GltfMaterial finish_material(const MaterialFactors& factors, Document& document);

/// KHR_texture_transform as a matrix: uv' = offset + rotation * scale * uv. A positive angle turns
/// the UV axes counter-clockwise as seen with v pointing down.
TextureSlot finish_slot(const TextureFactors& factors);

/// Makes all materials again from Document::material_factors, as if the file had these numbers.
void finish_materials(Document& document);

}  // namespace obscura::gltf
