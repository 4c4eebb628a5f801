// gltf/material_extensions.h - the material extensions of a glTF material become MaterialLayers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/document_parts.h"
#include "surface/material_layers.h"

#include <optional>

namespace obscura {

/// Reads the KHR_materials extensions that need layers; none when the material has none of them.
/// Values out of range are clamped with a warning.
std::optional<MaterialLayers> read_material_layers(DocumentReading& reading,
                                                   const JsonReader& material);

/// Reads a textureInfo with its KHR_texture_transform; what cannot be read leaves an empty slot.
TextureSlot read_texture_slot(DocumentReading& reading,
                              const JsonReader& object,
                              std::string_view key);

}  // namespace obscura
