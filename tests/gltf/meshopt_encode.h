// tests/gltf/meshopt_encode.h - compresses bytes and indices for EXT_meshopt_compression.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <meshoptimizer.h>
#include <string>
#include <vector>

namespace obscura::gltf::test {

inline std::string encode_attributes(const std::string& data, size_t stride) {
    const size_t count = data.size() / stride;
    std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
    out.resize(meshopt_encodeVertexBuffer(
        reinterpret_cast<unsigned char*>(out.data()), out.size(), data.data(), count, stride));
    return out;
}

template <typename Encode>
std::string encode_indices(const std::vector<uint32_t>& indices, size_t room, Encode encode) {
    std::string out(room, '\0');
    auto* to = reinterpret_cast<unsigned char*>(out.data());
    out.resize(encode(to, out.size(), indices.data(), indices.size()));
    return out;
}

inline std::string encode_triangles(const std::vector<uint32_t>& indices) {
    const size_t room = meshopt_encodeIndexBufferBound(indices.size(), 1U << 16);
    return encode_indices(
        indices, room, [](auto... given) { return meshopt_encodeIndexBuffer(given...); });
}

inline std::string encode_sequence(const std::vector<uint32_t>& indices) {
    const size_t room = meshopt_encodeIndexSequenceBound(indices.size(), 1U << 16);
    return encode_indices(
        indices, room, [](auto... given) { return meshopt_encodeIndexSequence(given...); });
}

}  // namespace obscura::gltf::test
