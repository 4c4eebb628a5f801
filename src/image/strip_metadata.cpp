// image/strip_metadata.cpp - removes metadata from encoded PNG and JPEG images.
// SPDX-License-Identifier: Apache-2.0
#include "image/strip_metadata.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;

size_t byte_at(ByteSpan bytes, size_t at) {
    return std::to_integer<size_t>(bytes[at]);
}

/// Collects the parts to keep; together they are at most as long as the original.
struct Parts {
    std::vector<std::byte> bytes;
    size_t used = 0;

    void append(ByteSpan part) {
        std::copy(part.begin(), part.end(), bytes.begin() + static_cast<std::ptrdiff_t>(used));
        used += part.size();
    }
};

bool is_needed_png_chunk(ByteSpan chunk) {
    const std::string_view type(reinterpret_cast<const char*>(chunk.data()) + 4, 4);
    const bool is_critical = (type[0] & 0x20) == 0;  // broken ones too: the decoder refuses them
    return is_critical || type == "tRNS";
}

void strip_png(ByteSpan bytes, Parts& out) {
    constexpr size_t signature = 8;
    constexpr size_t length_type_checksum = 12;
    out.append(bytes.first(signature));
    bytes = bytes.subspan(signature);
    while (bytes.size() >= length_type_checksum) {
        const size_t length = byte_at(bytes, 0) << 24 | byte_at(bytes, 1) << 16 |
                              byte_at(bytes, 2) << 8 | byte_at(bytes, 3);
        const size_t size = std::min(length + length_type_checksum, bytes.size());
        if (is_needed_png_chunk(bytes)) out.append(bytes.first(size));
        bytes = bytes.subspan(size);
    }
    out.append(bytes);
}

/// JFIF (APP0) and Adobe (APP14) say how colour is stored; the other APPn and comments do not.
bool is_needed_jpeg_segment(size_t marker) {
    const bool is_application = marker >= 0xE0 && marker <= 0xEF;
    return marker != 0xFE && (!is_application || marker == 0xE0 || marker == 0xEE);
}

void strip_jpeg(ByteSpan bytes, Parts& out) {
    constexpr size_t start_of_scan = 0xDA;
    out.append(bytes.first(2));
    size_t at = 2;
    while (at + 4 <= bytes.size()) {
        const size_t marker = byte_at(bytes, at + 1);
        if (byte_at(bytes, at) != 0xFF || marker == 0xFF || marker == 0) {
            ++at;  // a stray or filling byte
            continue;
        }
        if (marker == start_of_scan) break;
        const bool is_alone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9);
        const size_t length = is_alone ? 0 : byte_at(bytes, at + 2) << 8 | byte_at(bytes, at + 3);
        const size_t size = std::min(2 + length, bytes.size() - at);
        if (is_needed_jpeg_segment(marker)) out.append(bytes.subspan(at, size));
        at += size;
    }
    out.append(bytes.subspan(at));
}

}  // namespace

std::vector<std::byte> without_metadata(ByteSpan bytes, ImageFormat format) {
    Parts out{std::vector<std::byte>(bytes.size())};
    if (format == ImageFormat::png) {
        strip_png(bytes, out);
    } else if (format == ImageFormat::jpeg) {
        strip_jpeg(bytes, out);
    } else {
        out.append(bytes);
    }
    out.bytes.resize(out.used);
    return std::move(out.bytes);
}

}  // namespace obscura
