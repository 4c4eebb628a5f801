// gltf/parse/variants.h - KHR_materials_variants: sets of alternative materials.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

#include <string>

namespace obscura::gltf {

/// Reads the names; call it before the meshes, whose mappings refer to them.
void read_variants(DocumentReading& reading);

/// Reads which materials a primitive has in which variants.
void read_variant_materials(const DocumentReading& reading,
                            const ModelElement& object,
                            GltfPrimitive& out);

/// Gives every primitive the material that it has in this variant, or its own: also where the name
/// is empty. What was hidden shows again.
///
/// Errors  64 E-VARIANT-UNKNOWN, listing the names
Result<void> choose_variant(const std::string& name, Document& document);

/// Marks the materials that primitives have in any of these variants.
///
/// Errors  as choose_variant
Result<void> plan_variants(const std::vector<std::string>& names, Document& document);

}  // namespace obscura::gltf
