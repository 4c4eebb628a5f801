// gltf/document_buffers.cpp - reads buffers, buffer views and accessors.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/accessors.h"
#include "gltf/document_parts.h"

namespace obscura {

namespace {

struct Shape {
    const char* name;
    int rows;
    int columns;
};

constexpr Shape shapes[] = {{"SCALAR", 1, 1},
                            {"VEC2", 2, 1},
                            {"VEC3", 3, 1},
                            {"VEC4", 4, 1},
                            {"MAT2", 2, 2},
                            {"MAT3", 3, 3},
                            {"MAT4", 4, 4}};

ComponentType read_component_type(const JsonReader& object) {
    const uint64_t value = object.size("componentType", 0);
    if (value >= 5120 && value <= 5126 && value != 5124) return static_cast<ComponentType>(value);
    object.fault("componentType",
                 "E-ACC-TYPE",
                 std::to_string(value) +
                     " is not a component type; accepted are 5120, 5121, 5122, 5123, 5125, 5126");
    return ComponentType::uint8;
}

void read_sparse(DocumentReading& reading, const JsonReader& accessor, GltfAccessor& out) {
    if (!accessor.has("sparse")) return;
    const size_t view_count = reading.root.count("bufferViews");
    const JsonReader sparse = accessor.child("sparse");
    const JsonReader indices = sparse.child("indices");
    const JsonReader values = sparse.child("values");
    sparse.require("count");
    indices.require("bufferView");
    indices.require("componentType");
    values.require("bufferView");
    if (reading.root.failed()) return;
    out.sparse.count = sparse.size("count", 0);
    out.sparse.index_view = indices.index("bufferView", view_count, "buffer view");
    out.sparse.index_offset = indices.size("byteOffset", 0);
    out.sparse.index_type = read_component_type(indices);
    out.sparse.value_view = values.index("bufferView", view_count, "buffer view");
    out.sparse.value_offset = values.size("byteOffset", 0);
    if (out.sparse.count == 0 || out.sparse.count > out.count) {
        sparse.fault("count",
                     "E-ACC-SPARSE",
                     std::to_string(out.sparse.count) + " values are replaced, of " +
                         std::to_string(out.count) + "; accepted is 1 up to that");
    }
    if (out.sparse.index_type != ComponentType::uint8 &&
        out.sparse.index_type != ComponentType::uint16 &&
        out.sparse.index_type != ComponentType::uint32) {
        indices.fault("componentType", "E-ACC-TYPE", "sparse indices must be 5121, 5123 or 5125");
    }
}

void read_shape(const JsonReader& accessor, GltfAccessor& out) {
    const std::string type = accessor.text("type");
    for (const Shape& shape : shapes) {
        if (type != shape.name) continue;
        out.rows = shape.rows;
        out.columns = shape.columns;
        return;
    }
    accessor.fault(
        "type",
        "E-ACC-TYPE",
        "this is not an accessor type; accepted are SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
}

void read_accessor(DocumentReading& reading, const JsonReader& accessor) {
    accessor.require("componentType");
    accessor.require("count");
    accessor.require("type");
    if (reading.root.failed()) return;
    GltfAccessor out;
    out.view = accessor.index("bufferView", reading.root.count("bufferViews"), "buffer view");
    out.byte_offset = accessor.size("byteOffset", 0);
    out.component = read_component_type(accessor);
    out.normalized = accessor.boolean("normalized", false);
    out.count = accessor.size("count", 0);
    read_shape(accessor, out);
    if (out.count == 0) reading.empty.push_back(accessor.pointer());
    read_sparse(reading, accessor, out);
    const bool vector3 = out.rows == 3 && out.columns == 1;
    out.has_bounds =
        vector3 && accessor.numbers("min", out.low) && accessor.numbers("max", out.high);
    if (reading.root.failed()) return;
    const std::string problem = accessor_problem(reading.document, out);
    if (!problem.empty()) accessor.fault("", "E-ACC-RANGE", problem);
    if (accessor_is_misaligned(reading.document, out)) {
        reading.misaligned.push_back(accessor.pointer());
    }
    reading.document.accessors.push_back(out);
}

}  // namespace

size_t component_size(ComponentType type) {
    switch (type) {
        case ComponentType::int8:
        case ComponentType::uint8:
            return 1;
        case ComponentType::int16:
        case ComponentType::uint16:
            return 2;
        default:
            return 4;
    }
}

void read_buffers(DocumentReading& reading) {
    reading.root.each("buffers", [&](const JsonReader& buffer, size_t) {
        buffer.require("byteLength");
        GltfBuffer out;
        out.name = buffer.text("name");
        if (buffer.has("uri")) out.uri = buffer.text("uri");
        out.byte_length = buffer.size("byteLength", 1);
        if (out.byte_length == 0) {
            buffer.fault("byteLength", "E-BUF-LENGTH", "the length must be 1 or more");
        }
        reading.document.buffers.push_back(std::move(out));
    });
}

void read_views(DocumentReading& reading) {
    const size_t buffer_count = reading.root.count("buffers");
    reading.root.each("bufferViews", [&](const JsonReader& view, size_t) {
        view.require("buffer");
        view.require("byteLength");
        GltfBufferView out;
        out.buffer = view.index("buffer", buffer_count, "buffer");
        out.byte_offset = view.size("byteOffset", 0);
        out.byte_length = view.size("byteLength", 1);
        out.byte_stride = view.size("byteStride", 0);
        if (reading.root.failed()) return;
        const uint64_t room = reading.document.buffers[static_cast<size_t>(out.buffer)].byte_length;
        if (out.byte_offset > room || out.byte_length > room - out.byte_offset) {
            view.fault("",
                       "E-BUF-RANGE",
                       "bytes " + std::to_string(out.byte_offset) + " + " +
                           std::to_string(out.byte_length) + " leave the buffer of " +
                           std::to_string(room) + " bytes");
        }
        if (out.byte_length == 0) {
            view.fault("byteLength", "E-BUF-LENGTH", "the length must be 1 or more");
        }
        const bool stride_valid =
            out.byte_stride >= 4 && out.byte_stride <= 252 && out.byte_stride % 4 == 0;
        if (view.has("byteStride") && !stride_valid) {
            view.fault("byteStride",
                       "E-BUF-STRIDE",
                       std::to_string(out.byte_stride) +
                           " is not accepted: a stride is a multiple of 4 from 4 to 252");
        }
        read_view_meshopt(reading, view, out);
        reading.document.views.push_back(out);
    });
}

void read_accessors(DocumentReading& reading) {
    reading.root.each(
        "accessors", [&](const JsonReader& accessor, size_t) { read_accessor(reading, accessor); });
}

}  // namespace obscura
