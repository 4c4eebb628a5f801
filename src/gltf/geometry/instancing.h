// gltf/geometry/instancing.h - EXT_mesh_gpu_instancing: one node places its mesh many times.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/accessors.h"
#include "gltf/parse/document_reading.h"
#include "gltf/parse/node_graph.h"

#include <vector>

namespace obscura::gltf {

/// Limit on the instances of all nodes together.
inline constexpr uint64_t max_instances = 1U << 26;

/// Reads the extension's object of a node; other attributes (_ID) do not affect the image.
///
/// Errors  faults of the reader: 65 E-NODE-INSTANCING counts that differ, types that are not
/// allowed
GltfInstancing read_instancing(const DocumentReading& reading, const ModelElement& node);

/// False when the node places its mesh once, at its own transform.
bool is_instanced(const GltfInstancing& instancing);

/// The transforms of meshes: `placed`, where a node's entry is replaced by one entry per instance.
///
/// Errors  65 E-NODE-INSTANCING a rotation without length; 77 E-LIMIT-INSTANCES; as read_floats
/// Source  glTF extension EXT_mesh_gpu_instancing
Result<std::vector<PlacedNode>> expand_instances(const Document& document,
                                                 const BufferStore& buffers,
                                                 const std::vector<PlacedNode>& placed);

}  // namespace obscura::gltf
