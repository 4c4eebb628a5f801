// gltf/parse/document_meshopt.h - reads the meshopt compression extension of a buffer view.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

/// EXT_ and KHR_meshopt_compression of a view whose own numbers are good.
void read_view_meshopt(const DocumentReading& reading,
                       const ModelElement& view,
                       GltfBufferView& out);

}  // namespace obscura::gltf
