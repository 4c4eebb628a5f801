// gltf/parse/document_lights.h - reads EXT_lights_ies and EXT_lights_image_based.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

void read_light_profiles(DocumentReading& reading);
GltfProfileUse read_node_profile(DocumentReading& reading, const ModelElement& node);
void read_environments(DocumentReading& reading);

}  // namespace obscura::gltf
