// gltf/parse/document_meshes.h - reads meshes with their morph targets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

void read_meshes(DocumentReading& reading);

}  // namespace obscura::gltf
