// gltf/parse/glb.cpp - the binary container: a header and chunks.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/glb.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace obscura::gltf {

namespace {

constexpr size_t header_size = 12;
constexpr size_t chunk_header_size = 8;
constexpr uint32_t json_chunk = 0x4E4F534AU;    // "JSON"
constexpr uint32_t binary_chunk = 0x004E4942U;  // "BIN\0"

/// The caller has checked that four bytes are there.
uint32_t read_u32(std::span<const std::byte> bytes, size_t offset) {
    uint32_t out = 0;
    for (size_t i = 0; i < 4; ++i) {
        out |= std::to_integer<uint32_t>(bytes[offset + i]) << (8 * i);
    }
    return out;
}

tl::unexpected<Error> broken(const char* id, const std::string& where, std::string message) {
    return fail(ExitCode::bad_data, id, where, std::move(message));
}

struct Chunk {
    uint32_t type = 0;
    std::span<const std::byte> data;
    size_t end = 0;  ///< offset of the next chunk
};

Result<Chunk> read_chunk(std::span<const std::byte> bytes,
                         size_t offset,
                         const std::string& where) {
    const std::string place = "the chunk at byte " + std::to_string(offset);
    if (bytes.size() - offset < chunk_header_size) {
        return broken("E-GLB-TRUNCATED",
                      where,
                      place + " has only " + std::to_string(bytes.size() - offset) +
                          " of the 8 bytes of its header");
    }
    const uint32_t length = read_u32(bytes, offset);
    const size_t room = bytes.size() - offset - chunk_header_size;
    if (length > room) {
        return broken("E-GLB-CHUNK",
                      where,
                      place + " says that it has " + std::to_string(length) + " bytes, but only " +
                          std::to_string(room) + " follow");
    }
    const size_t begin = offset + chunk_header_size;
    return Chunk{read_u32(bytes, offset + 4), bytes.subspan(begin, length), begin + length};
}

/// Checks the 12 bytes of the header and returns the declared length.
Result<size_t> read_header(std::span<const std::byte> bytes, const std::string& where) {
    if (bytes.size() < header_size) {
        return broken("E-GLB-TRUNCATED",
                      where,
                      "the file ends after " + std::to_string(bytes.size()) +
                          " bytes, inside the 12 bytes of the GLB header");
    }
    const uint32_t version = read_u32(bytes, 4);
    if (version != 2) {
        return fail(ExitCode::unsupported,
                    "E-VERSION",
                    where,
                    "the GLB container has version " + std::to_string(version) +
                        "; only version 2 is accepted");
    }
    const size_t length = read_u32(bytes, 8);
    if (length > bytes.size()) {
        return broken("E-GLB-TRUNCATED",
                      where,
                      "the header says " + std::to_string(length) + " bytes, but the file has " +
                          std::to_string(bytes.size()) + ": it is cut off");
    }
    if (length < header_size + chunk_header_size) {
        return broken("E-GLB-CHUNK",
                      where,
                      "the header says " + std::to_string(length) +
                          " bytes, which is too short for a JSON chunk");
    }
    return length;
}

}  // namespace

bool is_glb(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

Result<GlbChunks> split_glb(std::span<const std::byte> bytes, const std::string& where, Log& log) {
    const Result<size_t> length = read_header(bytes, where);
    if (!length) return fail(length.error());
    if (*length < bytes.size()) {
        log.warn(where,
                 std::to_string(bytes.size() - *length) +
                     " bytes behind the end of the GLB container are ignored");
    }
    const std::span<const std::byte> body = bytes.first(*length);

    GlbChunks out;
    size_t number = 0;
    bool unaligned = false;
    for (size_t offset = header_size; offset < body.size(); ++number) {
        const Result<Chunk> chunk = read_chunk(body, offset, where);
        if (!chunk) return fail(chunk.error());
        unaligned = unaligned || chunk->data.size() % 4 != 0;
        if (number == 0 && chunk->type != json_chunk) {
            return broken("E-GLB-CHUNK", where, "the first chunk is not JSON");
        }
        if (number != 0 && chunk->type == json_chunk) {
            return broken("E-GLB-CHUNK", where, "there are two JSON chunks; one is accepted");
        }
        if (number == 0) {
            out.json = {reinterpret_cast<const char*>(chunk->data.data()), chunk->data.size()};
        }
        if (number == 1 && chunk->type == binary_chunk) out.binary = chunk->data;
        offset = chunk->end;
    }
    if (unaligned) log.warn(where, "a chunk's length is not a multiple of 4");
    // Some writers pad the text with zeros instead of spaces.
    while (!out.json.empty() && out.json.back() == '\0')
        out.json.remove_suffix(1);
    return out;
}

std::string_view guess_foreign_format(std::span<const std::byte> bytes) {
    struct Signature {
        std::string_view start;
        std::string_view name;
    };
    using namespace std::string_view_literals;
    static constexpr std::array signatures = {
        Signature{"\x1F\x8B"sv, "gzip-compressed data; unpack it first"sv},
        Signature{"PK\x03\x04"sv, "a ZIP archive; unpack it first"sv},
        Signature{"\x28\xB5\x2F\xFD"sv, "Zstandard-compressed data; unpack it first"sv},
        Signature{"<!DOCTYPE"sv, "an HTML page"sv},
        Signature{"<!doctype"sv, "an HTML page"sv},
        Signature{"<html"sv, "an HTML page"sv},
        Signature{"<?xml"sv, "an XML document"sv},
        Signature{"\x89PNG"sv, "a PNG picture"sv},
        Signature{"\xFF\xD8\xFF"sv, "a JPEG picture"sv},
        Signature{"v/1\x01"sv, "an OpenEXR picture; obscura denoise reads those"sv},
        Signature{"#?"sv, "a Radiance HDR picture"sv},
        Signature{"RIFF"sv, "a WebP picture"sv},
        Signature{"Kaydara FBX"sv, "an FBX scene; export it as glTF 2.0"sv},
        Signature{"; FBX"sv, "an FBX scene; export it as glTF 2.0"sv},
        Signature{"#usda"sv, "a USD scene; export it as glTF 2.0"sv},
        Signature{"PXR-USDC"sv, "a USD scene; export it as glTF 2.0"sv},
        Signature{"BLENDER"sv, "a Blender scene; export it as glTF 2.0"sv},
        Signature{"ply"sv, "a PLY mesh; export it as glTF 2.0"sv},
        Signature{"solid "sv, "an STL mesh; export it as glTF 2.0"sv},
        Signature{"#"sv, "an OBJ scene; export it as glTF 2.0"sv},
        Signature{"mtllib "sv, "an OBJ scene; export it as glTF 2.0"sv},
        Signature{"o "sv, "an OBJ scene; export it as glTF 2.0"sv},
        Signature{"v "sv, "an OBJ scene; export it as glTF 2.0"sv},
        Signature{"version https://git-lfs"sv, "a Git LFS pointer; fetch the file with git lfs"sv},
        Signature{"\xFF\xFE"sv, "UTF-16 text; glTF is UTF-8"sv},
        Signature{"\xFE\xFF"sv, "UTF-16 text; glTF is UTF-8"sv},
    };
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min<size_t>(bytes.size(), 64));
    for (const Signature& signature : signatures) {
        if (text.substr(0, signature.start.size()) == signature.start) return signature.name;
    }
    if (text.size() >= 2 && (text[0] == '\0') != (text[1] == '\0')) {
        return "UTF-16 text; glTF is UTF-8";
    }
    return {};
}

}  // namespace obscura::gltf
