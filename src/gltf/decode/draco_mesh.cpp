// gltf/decode/draco_mesh.cpp - decompresses a primitive of KHR_draco_mesh_compression.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/draco_mesh.h"

#include "gltf/decode/accessors.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <memory>
#include <optional>
#include <string_view>

namespace obscura::gltf {

namespace {

/// Regular meshes take less than a bit a triangle; a higher count is a bid for memory.
constexpr uint64_t max_triangles_per_byte = 1U << 12;
constexpr uint64_t triangles_always_allowed = 1U << 16;

/// Decodes one primitive.
struct DracoReader {
    const DracoSources& sources;
    const GltfPrimitive& primitive;
    const std::string& where;

    const GltfAccessor& accessor(int number) const {
        return sources.document.accessors[static_cast<size_t>(number)];
    }
    tl::unexpected<Error> bad(std::string message) const {
        return fail(ExitCode::bad_data,
                    "E-DRACO-DATA",
                    where + "/extensions/KHR_draco_mesh_compression",
                    std::move(message));
    }
};

/// Reads the triangle count at the head of the data, before the decoder allocates that many.
/// Nothing when the data end before it.
std::optional<uint32_t> declared_triangles(draco::DecoderBuffer buffer,
                                           const draco::DracoHeader& header) {
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        draco::GeometryMetadata metadata;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return {};
    }
    uint32_t triangles = 0;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        uint8_t traversal = 0;
        uint32_t vertices = 0;
        if (!buffer.Decode(&traversal) || !draco::DecodeVarint(&vertices, &buffer)) return {};
    }
    if (!draco::DecodeVarint(&triangles, &buffer)) return {};
    return triangles;
}

Result<void> check_header(const DracoReader& reader, std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header = {};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH) {
        return reader.bad("the data are no mesh that Draco made");
    }
    if (header.version_major != 2 || header.version_minor != 2) {
        return fail(ExitCode::unsupported,
                    "E-DRACO-VERSION",
                    reader.where,
                    "the data are of Draco bitstream " + std::to_string(header.version_major) +
                        "." + std::to_string(header.version_minor) + "; glTF has 2.2");
    }
    const std::optional<uint32_t> triangles = declared_triangles(buffer, header);
    if (!triangles) return reader.bad("the data end too early");
    const uint64_t count = reader.accessor(reader.primitive.indices).count;
    const bool strip = reader.primitive.mode == 5;
    if (strip ? *triangles > count : uint64_t{*triangles} * 3 != count) {
        return reader.bad("the data hold " + std::to_string(*triangles) +
                          " triangles, but the accessor of the indices has a count of " +
                          std::to_string(count));
    }
    if (*triangles > triangles_always_allowed &&
        *triangles / max_triangles_per_byte > bytes.size()) {
        return fail(ExitCode::refused,
                    "E-LIMIT-DECODED",
                    reader.where,
                    std::to_string(*triangles) + " triangles in " + std::to_string(bytes.size()) +
                        " bytes; accepted are " + std::to_string(max_triangles_per_byte) +
                        " a byte");
    }
    return {};
}

Result<std::unique_ptr<draco::Mesh>> decode_mesh(const DracoReader& reader) {
    const std::span<const std::byte> bytes =
        view_bytes(reader.sources.document, reader.sources.buffers, reader.primitive.draco_view);
    Result<void> header = check_header(reader, bytes);
    if (!header) return fail(std::move(header.error()));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        const std::string reason = decoded.status().error_msg_string();
        return reader.bad("the data are corrupt" + (reason.empty() ? "" : ": " + reason));
    }
    return std::move(decoded).value();
}

Result<std::vector<uint32_t>> read_triangles(const DracoReader& reader, const draco::Mesh& mesh) {
    std::vector<uint32_t> out;
    out.reserve(static_cast<size_t>(mesh.num_faces()) * 3);
    for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(f))) {
            if (point.value() >= mesh.num_points()) {
                return reader.bad("a triangle has a vertex that does not exist");
            }
            out.push_back(point.value());
        }
    }
    return out;
}

/// Every vertex's value as numbers of type T, packed; false when a value is missing or does not
/// fit.
template <typename T>
bool convert_values(const draco::PointAttribute& attribute, uint32_t vertices, Bytes& out) {
    const size_t width = static_cast<size_t>(attribute.num_components());
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < vertices) return false;
    out.resize(vertices * width * sizeof(T));
    std::vector<T> value(width);
    for (uint32_t v = 0; v < vertices; ++v) {
        const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(v));
        if (at.value() >= attribute.size() || !attribute.ConvertValue(at, value.data())) {
            return false;
        }
        std::copy_n(reinterpret_cast<const std::byte*>(value.data()),
                    width * sizeof(T),
                    out.data() + v * width * sizeof(T));
    }
    return true;
}

bool convert(const draco::PointAttribute& attribute,
             ComponentType type,
             uint32_t vertices,
             Bytes& out) {
    switch (type) {
        case ComponentType::int8:
            return convert_values<int8_t>(attribute, vertices, out);
        case ComponentType::uint8:
            return convert_values<uint8_t>(attribute, vertices, out);
        case ComponentType::int16:
            return convert_values<int16_t>(attribute, vertices, out);
        case ComponentType::uint16:
            return convert_values<uint16_t>(attribute, vertices, out);
        case ComponentType::uint32:
            return convert_values<uint32_t>(attribute, vertices, out);
        case ComponentType::float32:
            return convert_values<float>(attribute, vertices, out);
    }
    return false;
}

/// One attribute of the primitive as its accessor describes it.
Result<void> read_attribute(const DracoReader& reader,
                            const draco::Mesh& mesh,
                            int accessor_number,
                            int id,
                            DracoMesh& out) {
    if (id < 0) return {};
    const std::string name =
        "attribute " + std::to_string(id) + " (accessor " + std::to_string(accessor_number) + ") ";
    const GltfAccessor& accessor = reader.accessor(accessor_number);
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id));
    if (attribute == nullptr) return reader.bad(name + "is not in the data");
    if (accessor.columns != 1 || attribute->num_components() != accessor.rows) {
        return reader.bad(name + "has " + std::to_string(attribute->num_components()) +
                          " components; the accessor has another type");
    }
    if (accessor.count != mesh.num_points()) {
        return reader.bad(name + "has " + std::to_string(mesh.num_points()) +
                          " elements; the accessor's count is " + std::to_string(accessor.count));
    }
    DracoMesh::Attribute values{id, {}};
    if (!convert(*attribute, accessor.component, mesh.num_points(), values.values)) {
        return reader.bad(name +
                          "has values that do not fit the accessor's component type, or too "
                          "few of them");
    }
    out.attributes.push_back(std::move(values));
    return {};
}

}  // namespace

std::span<const std::byte> DracoMesh::values(int id) const {
    for (const Attribute& attribute : attributes) {
        if (attribute.id == id) return attribute.values;
    }
    return {};
}

Result<DracoMesh> decode_draco(const DracoSources& sources,
                               const GltfPrimitive& primitive,
                               const std::string& where) {
    const DracoReader reader{sources, primitive, where};
    const Result<std::unique_ptr<draco::Mesh>> mesh = decode_mesh(reader);
    if (!mesh) return fail(mesh.error());
    DracoMesh out;
    Result<std::vector<uint32_t>> indices = read_triangles(reader, **mesh);
    if (!indices) return fail(std::move(indices.error()));
    out.indices = std::move(*indices);

    const GltfAttributes& ids = primitive.draco_ids;
    Result<void> done = read_attribute(reader, **mesh, primitive.position, ids.position, out);
    if (done) done = read_attribute(reader, **mesh, primitive.normal, ids.normal, out);
    if (done) done = read_attribute(reader, **mesh, primitive.tangent, ids.tangent, out);
    if (done) done = read_attribute(reader, **mesh, primitive.color, ids.color, out);
    for (size_t set = 0; set < primitive.uv.size() && done; ++set)
        done = read_attribute(reader, **mesh, primitive.uv[set], ids.uv[set], out);
    for (size_t set = 0; set < ids.joints.size() && done; ++set)
        done = read_attribute(reader, **mesh, primitive.joints[set], ids.joints[set], out);
    for (size_t set = 0; set < ids.weights.size() && done; ++set)
        done = read_attribute(reader, **mesh, primitive.weights[set], ids.weights[set], out);
    if (!done) return fail(std::move(done.error()));
    // Attributes beside the compressed ones are read as usual, and checked against POSITION's
    // count.
    if ((*mesh)->num_points() != reader.accessor(primitive.position).count) {
        return reader.bad("the data hold " + std::to_string((*mesh)->num_points()) +
                          " vertices; POSITION has a count of " +
                          std::to_string(reader.accessor(primitive.position).count));
    }
    return out;
}

}  // namespace obscura::gltf
