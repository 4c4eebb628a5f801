// image/png_chunks.cpp - what an encoded PNG says about its colours.
// SPDX-License-Identifier: Apache-2.0
#include "image/png_chunks.h"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace obscura {

namespace {

using Bytes = std::vector<std::byte>;

constexpr size_t signature = 8;
constexpr size_t length_type_checksum = 12;

/// Source  section 5.5 and annex D: CRC-32 of a chunk's type and data
uint32_t checksum(std::span<const std::byte> bytes) {
    uint32_t crc = 0xFFFFFFFFU;
    for (const std::byte byte : bytes) {
        crc ^= std::to_integer<uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

void append(Bytes& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<std::byte>(value >> shift & 0xFF));
}

void append_chunk(Bytes& out, std::string_view type, std::initializer_list<int> data) {
    append(out, static_cast<uint32_t>(data.size()));
    const size_t begin = out.size();
    for (const char c : type)
        out.push_back(static_cast<std::byte>(c));
    for (const int value : data)
        out.push_back(static_cast<std::byte>(value));
    append(out, checksum(std::span(out).subspan(begin)));
}

void append_color_chunk(Bytes& out, const ColorCodePoints& code_points) {
    if (code_points == srgb_code_points) {
        append_chunk(out, "sRGB", {0});  // perceptual intent
    } else {
        append_chunk(out, "cICP", {code_points.primaries, code_points.transfer, 0, 1});
    }
}

}  // namespace

std::vector<std::byte> with_color_chunk(std::span<const std::byte> png,
                                        const std::optional<ColorCodePoints>& code_points) {
    Bytes out(png.begin(), png.begin() + signature);
    out.reserve(png.size() + 32);
    png = png.subspan(signature);
    while (png.size() >= length_type_checksum) {
        size_t length = 0;
        for (size_t i = 0; i < 4; ++i)
            length = length << 8 | std::to_integer<size_t>(png[i]);
        const std::string_view type(reinterpret_cast<const char*>(png.data()) + 4, 4);
        const auto chunk = png.first(std::min(length + length_type_checksum, png.size()));
        if (type != "oFFs") out.insert(out.end(), chunk.begin(), chunk.end());
        if (type == "IHDR" && code_points) append_color_chunk(out, *code_points);
        png = png.subspan(chunk.size());
    }
    return out;
}

}  // namespace obscura
