// gltf/geometry/instancing.h - EXT_mesh_gpu_instancing: one node places its mesh many times.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/accessors.h"
#include "gltf/parse/document_reading.h"
#include "gltf/parse/node_graph.h"

#include <vector>

namespace obscura {

/// What all nodes together may place.
inline constexpr uint64_t most_instances = 1U << 26;

/// Reads the extension's object of a node; attributes of other names (_ID) say nothing about a
/// picture.
///
/// Errors  faults of the reader: 65 E-NODE-INSTANCING counts that differ, types that are not
/// allowed
GltfInstancing read_instancing(const DocumentReading& reading, const ModelElement& node);

/// False where the node's mesh stands once, where the node is.
bool is_instanced(const GltfInstancing& instancing);

/// The places of meshes: as `placed`, with a row for each instance instead of one for its node.
///
/// Errors  65 E-NODE-INSTANCING a rotation without length; 77 E-LIMIT-INSTANCES; as read_floats
/// Source  glTF extension EXT_mesh_gpu_instancing
Result<std::vector<PlacedNode>> expand_instances(const Document& document,
                                                 const BufferStore& buffers,
                                                 const std::vector<PlacedNode>& placed);

}  // namespace obscura
