// gltf/parse/document_buffers.cpp - reads buffers, buffer views and accessors.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_buffers.h"

#include "gltf/decode/accessors.h"
#include "gltf/parse/document_meshopt.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

/// tinygltf's type of an accessor.
struct Shape {
    int type;
    int rows;
    int columns;
};

constexpr Shape shapes[] = {{TINYGLTF_TYPE_SCALAR, 1, 1},
                            {TINYGLTF_TYPE_VEC2, 2, 1},
                            {TINYGLTF_TYPE_VEC3, 3, 1},
                            {TINYGLTF_TYPE_VEC4, 4, 1},
                            {TINYGLTF_TYPE_MAT2, 2, 2},
                            {TINYGLTF_TYPE_MAT3, 3, 3},
                            {TINYGLTF_TYPE_MAT4, 4, 4}};

void read_sparse(const tinygltf::Accessor& accessor, const ModelElement& place, GltfAccessor& out) {
    if (!accessor.sparse.isSparse) return;
    const ModelElement sparse = place.child("sparse", accessor.extensions);
    const auto& indices = accessor.sparse.indices;
    const auto& values = accessor.sparse.values;
    out.sparse.count = static_cast<uint64_t>(accessor.sparse.count);
    out.sparse.index_view = indices.bufferView;
    out.sparse.index_offset = static_cast<uint64_t>(indices.byteOffset);
    out.sparse.index_type = static_cast<ComponentType>(indices.componentType);
    out.sparse.value_view = values.bufferView;
    out.sparse.value_offset = static_cast<uint64_t>(values.byteOffset);
    if (out.sparse.count == 0 || out.sparse.count > out.count) {
        sparse.fault("count",
                     "E-ACC-SPARSE",
                     std::to_string(out.sparse.count) + " values are replaced, of " +
                         std::to_string(out.count) + "; accepted is 1 up to that");
    }
    if (out.sparse.index_type != ComponentType::uint8 &&
        out.sparse.index_type != ComponentType::uint16 &&
        out.sparse.index_type != ComponentType::uint32) {
        sparse.child("indices", accessor.extensions)
            .fault("componentType", "E-ACC-TYPE", "sparse indices must be 5121, 5123 or 5125");
    }
}

void read_bounds(const tinygltf::Accessor& accessor, GltfAccessor& out) {
    const bool vector3 = out.rows == 3 && out.columns == 1;
    out.has_bounds = vector3 && accessor.minValues.size() == 3 && accessor.maxValues.size() == 3;
    if (!out.has_bounds) return;
    std::copy_n(accessor.minValues.begin(), 3, out.low.begin());
    std::copy_n(accessor.maxValues.begin(), 3, out.high.begin());
}

void read_accessor(DocumentReading& reading,
                   const tinygltf::Accessor& accessor,
                   const ModelElement& place) {
    GltfAccessor out;
    out.view = accessor.bufferView;
    out.byte_offset = accessor.byteOffset;
    out.component = static_cast<ComponentType>(accessor.componentType);
    out.normalized = accessor.normalized;
    out.count = accessor.count;
    for (const Shape& shape : shapes) {
        if (accessor.type != shape.type) continue;
        out.rows = shape.rows;
        out.columns = shape.columns;
    }
    if (out.count == 0) reading.empty.push_back(place.pointer());
    read_sparse(accessor, place, out);
    read_bounds(accessor, out);
    if (reading.failed()) return;
    const std::string problem = accessor_problem(reading.document, out);
    if (!problem.empty()) place.fault("", "E-ACC-RANGE", problem);
    if (accessor_is_misaligned(reading.document, out)) {
        reading.misaligned.push_back(place.pointer());
    }
    reading.document.accessors.push_back(out);
}

}  // namespace

void read_buffers(DocumentReading& reading) {
    for (size_t i = 0; i < reading.model.buffers.size(); ++i)
        reading.document.buffers[i].name = reading.model.buffers[i].name;
}

void read_views(DocumentReading& reading) {
    const auto read = [&](const tinygltf::BufferView& view, const ModelElement& place, size_t) {
        GltfBufferView out;
        out.buffer = view.buffer;
        out.byte_offset = view.byteOffset;
        out.byte_length = view.byteLength;
        out.byte_stride = view.byteStride;
        const uint64_t room = reading.document.buffers[static_cast<size_t>(out.buffer)].byte_length;
        if (out.byte_offset > room || out.byte_length > room - out.byte_offset) {
            place.fault("",
                        "E-BUF-RANGE",
                        "bytes " + std::to_string(out.byte_offset) + " + " +
                            std::to_string(out.byte_length) + " leave the buffer of " +
                            std::to_string(room) + " bytes");
        }
        if (out.byte_length == 0) {
            place.fault("byteLength", "E-BUF-LENGTH", "the length must be 1 or more");
        }
        read_view_meshopt(reading, place, out);
        reading.document.views.push_back(out);
    };
    each_element(reading, "bufferViews", reading.model.bufferViews, read);
}

void read_accessors(DocumentReading& reading) {
    each_element(reading,
                 "accessors",
                 reading.model.accessors,
                 [&](const tinygltf::Accessor& accessor, const ModelElement& place, size_t) {
                     read_accessor(reading, accessor, place);
                 });
}

}  // namespace obscura::gltf
