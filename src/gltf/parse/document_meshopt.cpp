// gltf/parse/document_meshopt.cpp - reads the meshopt compression extension of a buffer view.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_meshopt.h"

namespace obscura::gltf {

namespace {

/// Both name the same object; what only the younger one has (version 1 of the attribute codec, the
/// filter COLOR) is read under either name.
constexpr const char* meshopt_names[] = {"KHR_meshopt_compression", "EXT_meshopt_compression"};

MeshoptMode read_mode(const ValueReader& object) {
    object.require("mode");
    const std::string mode = object.text("mode");
    if (mode == "TRIANGLES") return MeshoptMode::triangles;
    if (mode == "INDICES") return MeshoptMode::indices;
    if (mode != "ATTRIBUTES") {
        object.fault(
            "mode", "E-MESHOPT-MODE", "accepted are \"ATTRIBUTES\", \"TRIANGLES\" and \"INDICES\"");
    }
    return MeshoptMode::attributes;
}

MeshoptFilter read_filter(const ValueReader& object) {
    const std::string filter = object.text("filter", "NONE");
    if (filter == "OCTAHEDRAL") return MeshoptFilter::octahedral;
    if (filter == "QUATERNION") return MeshoptFilter::quaternion;
    if (filter == "EXPONENTIAL") return MeshoptFilter::exponential;
    if (filter == "COLOR") return MeshoptFilter::color;
    if (filter != "NONE") {
        object.fault("filter",
                     "E-MESHOPT-MODE",
                     "accepted are \"NONE\", \"OCTAHEDRAL\", \"QUATERNION\", \"EXPONENTIAL\" and "
                     "\"COLOR\"");
    }
    return MeshoptFilter::none;
}

bool stride_fits(const GltfMeshopt& meshopt) {
    const uint64_t stride = meshopt.byte_stride;
    if (meshopt.mode != MeshoptMode::attributes) return stride == 2 || stride == 4;
    switch (meshopt.filter) {
        case MeshoptFilter::octahedral:
        case MeshoptFilter::color:
            return stride == 4 || stride == 8;
        case MeshoptFilter::quaternion:
            return stride == 8;
        default:
            return stride >= 4 && stride <= 256 && stride % 4 == 0;
    }
}

void check_layout(const ValueReader& object, const GltfMeshopt& meshopt, uint64_t view_length) {
    if (!stride_fits(meshopt)) {
        object.fault("byteStride",
                     "E-MESHOPT-LAYOUT",
                     std::to_string(meshopt.byte_stride) +
                         " does not fit the mode and filter; accepted are 2 or 4 for indices, 8 "
                         "for QUATERNION, 4 or 8 for OCTAHEDRAL and COLOR, else a multiple of 4 up "
                         "to 256");
    }
    if (meshopt.mode != MeshoptMode::attributes && meshopt.filter != MeshoptFilter::none) {
        object.fault("filter", "E-MESHOPT-MODE", "a filter needs the mode \"ATTRIBUTES\"");
    }
    uint64_t length = 0;
    if (__builtin_mul_overflow(meshopt.count, meshopt.byte_stride, &length) ||
        length != view_length) {
        object.fault("count",
                     "E-MESHOPT-LAYOUT",
                     std::to_string(meshopt.count) + " elements of " +
                         std::to_string(meshopt.byte_stride) +
                         " bytes are not the view's byteLength of " + std::to_string(view_length));
    }
    if (meshopt.mode == MeshoptMode::triangles && meshopt.count % 3 != 0) {
        object.fault("count",
                     "E-MESHOPT-LAYOUT",
                     std::to_string(meshopt.count) +
                         " indices are no whole number of triangles; a multiple of 3 is needed");
    }
}

}  // namespace

void read_view_meshopt(const DocumentReading& reading,
                       const ModelElement& view,
                       GltfBufferView& out) {
    for (const char* name : meshopt_names) {
        if (!view.has_extension(name)) continue;
        const ValueReader object = view.extension(name);
        for (const char* key : {"buffer", "byteLength", "byteStride", "count"})
            object.require(key);
        GltfMeshopt meshopt;
        meshopt.buffer = object.index("buffer", reading.document.buffers.size(), "buffer");
        meshopt.byte_offset = object.size("byteOffset", 0);
        meshopt.byte_length = object.size("byteLength", 0);
        meshopt.byte_stride = object.size("byteStride", 0);
        meshopt.count = object.size("count", 0);
        meshopt.mode = read_mode(object);
        meshopt.filter = read_filter(object);
        if (reading.failed()) return;
        const uint64_t room =
            reading.document.buffers[static_cast<size_t>(meshopt.buffer)].byte_length;
        if (meshopt.byte_offset > room || meshopt.byte_length > room - meshopt.byte_offset) {
            object.fault("",
                         "E-BUF-RANGE",
                         "bytes " + std::to_string(meshopt.byte_offset) + " + " +
                             std::to_string(meshopt.byte_length) + " leave the buffer of " +
                             std::to_string(room) + " bytes");
        }
        check_layout(object, meshopt, out.byte_length);
        out.meshopt = meshopt;
        return;
    }
}

}  // namespace obscura::gltf
