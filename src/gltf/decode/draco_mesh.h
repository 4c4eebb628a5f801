// gltf/decode/draco_mesh.h - decompresses a primitive of KHR_draco_mesh_compression.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/buffers.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura::gltf {

/// The decoded contents of one compressed primitive.
struct DracoMesh {
    /// Elements as their accessor describes them, without gaps.
    struct Attribute {
        int id = -1;
        Bytes values;
    };
    std::vector<uint32_t> indices;  ///< 3 a triangle, below the number of vertices
    std::vector<Attribute> attributes;

    /// The elements of an attribute by its number in the compressed data; empty: it has none.
    std::span<const std::byte> values(int id) const;
};

struct DracoSources {
    const Document& document;
    const BufferStore& buffers;
};

/// Decodes the attributes that are read. The primitive has indices and positions.
///
/// In      where: the primitive, for messages
/// Errors  65 E-DRACO-DATA the data are corrupt, or disagree with the accessors' counts and types;
///         69 E-DRACO-VERSION not bitstream 2.2; 77 E-LIMIT-DECODED too many triangles for so few
///         bytes
/// Source  KHR_draco_mesh_compression; "Draco 3D Data Compression Technology", bitstream 2.2
Result<DracoMesh> decode_draco(const DracoSources& sources,
                               const GltfPrimitive& primitive,
                               const std::string& where);

}  // namespace obscura::gltf
