// gltf/variants.h - KHR_materials_variants: primitives with a material for each look of a product.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/document_parts.h"

#include <string>

namespace obscura {

/// Reads the names; before the meshes, whose mappings count on them.
void read_variants(DocumentReading& reading);

/// Reads which materials a primitive has in which variants.
void read_variant_materials(DocumentReading& reading, const JsonReader& object, GltfPrimitive& out);

/// Gives every primitive the material that it has in this variant; one without keeps its own.
///
/// Errors  64 E-VARIANT-UNKNOWN, listing the names
Result<void> choose_variant(const std::string& name, Document& document);

}  // namespace obscura
