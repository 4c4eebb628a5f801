// gltf/parse/document_materials.h - reads images, samplers, textures and materials.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

/// The images' URIs and views are in the document already.
void read_images(DocumentReading& reading);
void read_samplers(DocumentReading& reading);
void read_textures(DocumentReading& reading);
void read_materials(DocumentReading& reading);

}  // namespace obscura::gltf
