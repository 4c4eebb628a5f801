// gltf/parse/document_nodes.h - reads nodes, scenes, cameras and lights.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

void read_nodes(DocumentReading& reading);
void read_scenes(DocumentReading& reading);
void read_cameras(DocumentReading& reading);
void read_lights(DocumentReading& reading);

}  // namespace obscura::gltf
