// gltf/geometry/primitive_reader.cpp - reads the attributes of one primitive.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/primitive_reader.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

constexpr uint64_t max_vertices = (1U << 29) - 1;

bool has_quantization(const Document& document) {
    const auto is_it = [](const ExtensionInfo& info) {
        return info.name == "KHR_mesh_quantization";
    };
    return std::any_of(document.extensions.begin(), document.extensions.end(), is_it);
}

bool rule_allows(const AttributeRule& rule, const GltfAccessor& accessor, bool quantization) {
    if (accessor.columns != 1) return false;
    if (accessor.rows < rule.min_rows || accessor.rows > rule.max_rows) return false;
    const uint32_t type = type_bit(accessor.component);
    if (rule.only != 0) return !accessor.normalized && (rule.only & type) != 0;
    if (type == float_type) return !accessor.normalized;
    const uint32_t normalized = rule.normalized | (quantization ? rule.quantized_normalized : 0U);
    const uint32_t plain = rule.plain | (quantization ? rule.quantized_plain : 0U);
    return ((accessor.normalized ? normalized : plain) & type) != 0;
}

}  // namespace

Result<void> prepare_primitive(PrimitiveReader& reader) {
    const GltfPrimitive& primitive = reader.primitive();
    const GltfAccessor& position =
        reader.document.accessors[static_cast<size_t>(primitive.position)];
    if (position.count > max_vertices) {
        return fail(ExitCode::refused,
                    "E-LIMIT-VERTICES",
                    reader.where(),
                    std::to_string(position.count) + " vertices; at most " +
                        std::to_string(max_vertices) + " are accepted");
    }
    reader.vertex_count = position.count;
    const bool no_indices =
        primitive.indices >= 0 &&
        reader.document.accessors[static_cast<size_t>(primitive.indices)].count == 0;
    if (position.count == 0 || no_indices) {
        return reader.bad("E-MESH-EMPTY", "the primitive has no vertices; 1 or more are expected");
    }
    if (primitive.draco_view < 0) return {};
    Result<DracoMesh> mesh =
        decode_draco({reader.document, reader.store}, primitive, reader.where());
    if (!mesh) return fail(std::move(mesh.error()));
    reader.draco = std::move(*mesh);
    return {};
}

Result<std::vector<float>> read_attribute(PrimitiveReader& reader,
                                          int accessor,
                                          int draco_id,
                                          const AttributeRule& rule) {
    if (accessor < 0) return std::vector<float>{};
    const GltfAccessor& record = reader.document.accessors[static_cast<size_t>(accessor)];
    if (!rule_allows(rule, record, has_quantization(reader.document))) {
        return reader.bad("E-MESH-ATTRIBUTE",
                          std::string(rule.name) + " is accessor " + std::to_string(accessor) +
                              ", whose type, component type or normalization glTF does not allow "
                              "there (other integers need KHR_mesh_quantization)");
    }
    if (record.count != reader.vertex_count) {
        return reader.bad("E-MESH-COUNT",
                          std::string(rule.name) + " has " + std::to_string(record.count) +
                              " elements and POSITION " + std::to_string(reader.vertex_count) +
                              "; they must agree");
    }
    if (record.sparse.count != 0 &&
        !sparse_indices_increase(reader.document, reader.store, accessor)) {
        reader.issues |= issue_bit(MeshIssue::unsorted_sparse);
    }
    return read_floats(
        reader.document, reader.store, accessor, reader.choice, reader.draco.values(draco_id));
}

}  // namespace obscura::gltf
