// gltf/decode/meshopt.cpp - decompresses the buffer views of EXT_ and KHR_meshopt_compression.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/meshopt.h"

#include "base/parallel.h"
#include "gltf/decode/meshopt_attributes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <meshoptimizer.h>

namespace obscura::gltf {

namespace {

/// Most bytes that one compressed byte can decode to; larger claims are refused before memory is
/// allocated. A block of 256 attribute elements takes at least a quarter of a byte for each byte of
/// an element; a triangle takes a byte, and so does an index.
uint64_t largest_growth(MeshoptMode mode) {
    switch (mode) {
        case MeshoptMode::attributes:
            return 1024;
        case MeshoptMode::triangles:
            return 12;
        case MeshoptMode::indices:
            return 4;
    }
    return 0;
}

std::string where_of(const Document& document, size_t view) {
    return document.at("bufferViews", view);
}

tl::unexpected<Error> bad_data(const Document& document, size_t view, std::string message) {
    return fail(ExitCode::bad_data, "E-MESHOPT-DATA", where_of(document, view), std::move(message));
}

/// First byte of data in version 1 of the attribute codec.
constexpr std::byte attributes_v1{0xa1};

/// The library's codes for the three modes; 0 is success.
int decode_elements(const GltfMeshopt& meshopt, std::span<const std::byte> from, Bytes& out) {
    const auto* data = reinterpret_cast<const unsigned char*>(from.data());
    switch (meshopt.mode) {
        case MeshoptMode::attributes:
            if (from.front() == attributes_v1) {
                return decode_attributes_v1(from, {meshopt.count, meshopt.byte_stride}, out) ? 0
                                                                                             : -1;
            }
            return meshopt_decodeVertexBuffer(
                out.data(), meshopt.count, meshopt.byte_stride, data, from.size());
        case MeshoptMode::triangles:
            return meshopt_decodeIndexBuffer(
                out.data(), meshopt.count, meshopt.byte_stride, data, from.size());
        case MeshoptMode::indices:
            return meshopt_decodeIndexSequence(
                out.data(), meshopt.count, meshopt.byte_stride, data, from.size());
    }
    return -1;
}

/// Undoes the filter COLOR on elements of four T: luma, two chromas, and alpha whose highest set
/// bit tells the precision. The library has it only in newer versions.
template <typename T>
void decode_colors(Bytes& bytes) {
    constexpr int largest = std::numeric_limits<T>::max();
    const auto signed_value = [](T bits) {  // two's complement
        const int value = bits;
        return value > largest / 2 ? value - largest - 1 : value;
    };
    for (size_t at = 0; at + 4 * sizeof(T) <= bytes.size(); at += 4 * sizeof(T)) {
        std::array<T, 4> in;
        std::memcpy(in.data(), bytes.data() + at, sizeof(in));
        const int ones = static_cast<int>(std::bit_ceil(in[3] + 1U)) - 1;
        const float scale = static_cast<float>(largest) / static_cast<float>(std::max(ones, 1));
        const int y = in[0];
        const int co = signed_value(in[1]);
        const int cg = signed_value(in[2]);
        const int alpha = in[3] & (ones >> 1);
        const std::array<int, 4> rgba = {
            y + co - cg, y + cg, y - co - cg, alpha << 1 | (alpha & 1)};
        for (size_t i = 0; i < 4; ++i) {
            const float value = std::round(static_cast<float>(rgba[i]) * scale);
            in[i] = static_cast<T>(std::clamp(value, 0.0f, static_cast<float>(largest)));
        }
        std::memcpy(bytes.data() + at, in.data(), sizeof(in));
    }
}

void undo_filter(const GltfMeshopt& meshopt, Bytes& bytes) {
    switch (meshopt.filter) {
        case MeshoptFilter::none:
            return;
        case MeshoptFilter::octahedral:
            return meshopt_decodeFilterOct(bytes.data(), meshopt.count, meshopt.byte_stride);
        case MeshoptFilter::quaternion:
            return meshopt_decodeFilterQuat(bytes.data(), meshopt.count, meshopt.byte_stride);
        case MeshoptFilter::exponential:
            return meshopt_decodeFilterExp(bytes.data(), meshopt.count, meshopt.byte_stride);
        case MeshoptFilter::color:
            return meshopt.byte_stride == 4 ? decode_colors<uint8_t>(bytes)
                                            : decode_colors<uint16_t>(bytes);
    }
}

/// True when the data begin as the newest known version of their codec, or an older one, does.
bool version_is_known(const GltfMeshopt& meshopt, std::byte first) {
    const unsigned header = std::to_integer<unsigned>(first);
    switch (meshopt.mode) {
        case MeshoptMode::attributes:
            return header == 0xa0 || first == attributes_v1;
        case MeshoptMode::triangles:
            return header == 0xe0 || header == 0xe1;
        case MeshoptMode::indices:
            return header == 0xd0 || header == 0xd1;
    }
    return false;
}

Result<Bytes> decode_view(const Document& document, const BufferStore& store, size_t view) {
    const GltfMeshopt& meshopt = document.views[view].meshopt;
    const auto from = checked_span(store.buffers[static_cast<size_t>(meshopt.buffer)],
                                   {meshopt.byte_offset, 1, meshopt.byte_length, 1});
    if (!from || from->empty()) return bad_data(document, view, "the compressed data are missing");
    Bytes out(meshopt.count * meshopt.byte_stride);
    if (decode_elements(meshopt, *from, out) != 0) {
        if (!version_is_known(meshopt, from->front())) {
            return fail(ExitCode::unsupported,
                        "E-MESHOPT-VERSION",
                        where_of(document, view),
                        "the data begin with the byte " +
                            std::to_string(std::to_integer<unsigned>(from->front())) +
                            ", which is not their codec's; accepted is 160 or 161 for "
                            "attributes, 224 or 225 for triangles, 208 or 209 for indices");
        }
        return bad_data(document,
                        view,
                        "the compressed data are corrupt, or do not hold " +
                            std::to_string(meshopt.count) + " elements of " +
                            std::to_string(meshopt.byte_stride) + " bytes");
    }
    undo_filter(meshopt, out);
    return out;
}

/// Checks declared sizes against the data and the limits, before anything is allocated.
Result<MemoryCharge> check_sizes(const Document& document, const std::vector<size_t>& views) {
    uint64_t total = 0;
    for (const size_t view : views) {
        const GltfMeshopt& meshopt = document.views[view].meshopt;
        const uint64_t size = document.views[view].byte_length;
        if (size / largest_growth(meshopt.mode) > meshopt.byte_length) {
            return bad_data(document,
                            view,
                            std::to_string(meshopt.byte_length) + " compressed bytes cannot hold " +
                                std::to_string(size));
        }
        if (__builtin_add_overflow(total, size, &total) || total > max_decoded_bytes) {
            return fail(ExitCode::refused,
                        "E-LIMIT-DECODED",
                        where_of(document, view),
                        "the compressed views become more than " +
                            std::to_string(max_decoded_bytes >> 20) + " MiB");
        }
    }
    return charge_memory(MemoryUse::buffers, "decompressed buffer views", total);
}

}  // namespace

Result<void> decode_meshopt(const Document& document, BufferStore& store) {
    std::vector<size_t> views;
    for (size_t i = 0; i < document.views.size(); ++i) {
        if (document.views[i].meshopt.buffer >= 0) views.push_back(i);
    }
    if (views.empty()) return {};
    Result<MemoryCharge> charge = check_sizes(document, views);
    if (!charge) return fail(std::move(charge.error()));
    store.decoded_charge = std::move(*charge);

    std::vector<Result<Bytes>> decoded(views.size());
    parallel_for(views.size(),
                 [&](size_t i) { decoded[i] = decode_view(document, store, views[i]); });
    store.decoded.resize(document.views.size());
    for (size_t i = 0; i < views.size(); ++i) {
        if (!decoded[i]) return fail(std::move(decoded[i].error()));
        store.decoded[views[i]] = std::move(*decoded[i]);
    }
    return {};
}

}  // namespace obscura::gltf
