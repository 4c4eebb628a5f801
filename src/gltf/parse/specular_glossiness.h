// gltf/parse/specular_glossiness.h - KHR_materials_pbrSpecularGlossiness as metal-roughness.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <cstdint>
#include <span>

namespace obscura::gltf {

/// Puts the extension's material, where there is one and it is not unlit, in place of the core's: a
/// dielectric whose reflectance at normal incidence is the specular colour, over the diffuse one.
/// A specular-glossiness texture becomes the specular colour's texture, and a copy of its image the
/// roughness' (GltfImage::glossiness).
///
/// In      out: as the core and the other extensions have it
/// Source  KHR_materials_specular, "Specular-glossiness materials": ior 0
void finish_specular_glossiness(const MaterialFactors& factors,
                                Document& document,
                                GltfMaterial& out);

/// Turns texels of glossiness (in A) into those of roughness (in G): 1 - factor * A.
///
/// In      low_bytes: of 16-bit texels; empty where they have 8
void roughness_from_glossiness(std::span<uint32_t> texels,
                               std::span<uint32_t> low_bytes,
                               double factor);

}  // namespace obscura::gltf
