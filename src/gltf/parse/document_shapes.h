// gltf/parse/document_shapes.h - reads OBSCURA_shape and KHR_implicit_shapes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

void read_shapes(DocumentReading& reading);
void read_node_shape(const DocumentReading& reading, const ModelElement& node, GltfNode& out);

}  // namespace obscura::gltf
