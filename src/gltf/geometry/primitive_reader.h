// gltf/geometry/primitive_reader.h - reads and checks a primitive's attributes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/draco_mesh.h"
#include "gltf/geometry/mesh_primitive.h"

#include <string>
#include <utility>
#include <vector>

namespace obscura::gltf {

constexpr uint32_t type_bit(ComponentType type) {
    return 1U << (static_cast<uint32_t>(type) - 5120U);
}

inline constexpr uint32_t float_type = type_bit(ComponentType::float32);
inline constexpr uint32_t unsigned_types =
    type_bit(ComponentType::uint8) | type_bit(ComponentType::uint16);
inline constexpr uint32_t signed_types =
    type_bit(ComponentType::int8) | type_bit(ComponentType::int16);

/// Component types that a vertex attribute may have, in the core and with KHR_mesh_quantization.
struct AttributeRule {
    const char* name;
    int min_rows;
    int max_rows;
    uint32_t normalized;            ///< component types that may be normalized
    uint32_t quantized_normalized;  ///< the same with the extension
    uint32_t quantized_plain;       ///< integers as they are, with the extension
    uint32_t only = 0;              ///< not 0: nothing but such integers, as they are
    uint32_t plain = 0;             ///< integers as they are, with no extension for it
};

inline constexpr AttributeRule position_rule = {
    "POSITION", 3, 3, 0, unsigned_types | signed_types, unsigned_types | signed_types};
inline constexpr AttributeRule normal_rule = {"NORMAL", 3, 3, 0, signed_types, 0};
inline constexpr AttributeRule tangent_rule = {"TANGENT", 4, 4, 0, signed_types, 0};
inline constexpr AttributeRule uv_rule = {
    "TEXCOORD", 2, 2, unsigned_types, unsigned_types | signed_types, unsigned_types | signed_types};
inline constexpr AttributeRule color_rule = {"COLOR_0", 3, 4, unsigned_types, unsigned_types, 0};

/// Reads the attributes of one primitive.
struct PrimitiveReader {
    const Document& document;
    const BufferStore& store;
    PrimitiveName name;
    uint64_t vertex_count = 0;  ///< as in the file
    ElementChoice choice = {};
    uint32_t issues = 0;   ///< found while reading attributes
    DracoMesh draco = {};  ///< empty: the primitive is not compressed

    const GltfPrimitive& primitive() const {
        return document.meshes[static_cast<size_t>(name.mesh)]
            .primitives[static_cast<size_t>(name.primitive)];
    }
    std::string where() const {
        return document.at("meshes", static_cast<size_t>(name.mesh)) + "/primitives/" +
               std::to_string(name.primitive);
    }
    tl::unexpected<Error> bad(const char* id, std::string message) const {
        return fail(ExitCode::bad_data, id, where(), std::move(message));
    }
};

/// Checks declared counts against the limits and decompresses. The primitive has POSITION.
///
/// Errors  65 E-MESH-EMPTY, E-DRACO-DATA; 69 E-DRACO-VERSION; 77 E-LIMIT-VERTICES
Result<void> prepare_primitive(PrimitiveReader& reader);

/// Reads one attribute of the vertices in reader.choice; an accessor of -1 gives nothing.
///
/// In      draco_id: its number in the compressed data, -1: it is not in them
/// Errors  65 E-MESH-ATTRIBUTE, E-MESH-COUNT; those of read_floats
Result<std::vector<float>> read_attribute(PrimitiveReader& reader,
                                          int accessor,
                                          int draco_id,
                                          const AttributeRule& rule);

}  // namespace obscura::gltf
