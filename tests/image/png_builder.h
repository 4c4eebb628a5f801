// tests/image/png_builder.h - PNG files of every kind, byte by byte and without compression.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <vector>

namespace obscura::testing_images {

using ByteVector = std::vector<std::byte>;

inline void append(ByteVector& out, std::initializer_list<unsigned> bytes) {
    for (const unsigned byte : bytes)
        out.push_back(static_cast<std::byte>(byte & 0xFF));
}

inline void append_text(ByteVector& out, std::string_view text) {
    for (const char c : text)
        out.push_back(static_cast<std::byte>(c));
}

inline void append_big_endian(ByteVector& out, uint32_t value) {
    append(out, {value >> 24, value >> 16, value >> 8, value});
}

inline uint32_t crc32(const std::byte* bytes, size_t count) {
    uint32_t crc = 0xFFFFFFFFU;
    for (size_t i = 0; i < count; ++i) {
        crc ^= std::to_integer<uint32_t>(bytes[i]);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

/// A PNG under construction: chunks in the order in which they are added.
class PngBuilder {
public:
    PngBuilder(uint32_t width, uint32_t height, unsigned bits, unsigned color_type) {
        append(png_, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'});
        ByteVector header;
        append_big_endian(header, width);
        append_big_endian(header, height);
        append(header, {bits, color_type, 0, 0, 0});
        chunk("IHDR", header);
    }

    PngBuilder& chunk(std::string_view type, const ByteVector& data) {
        append_big_endian(png_, static_cast<uint32_t>(data.size()));
        const size_t begin = png_.size();
        append_text(png_, type);
        png_.insert(png_.end(), data.begin(), data.end());
        append_big_endian(png_, crc32(png_.data() + begin, png_.size() - begin));
        return *this;
    }
    PngBuilder& chunk(std::string_view type, std::initializer_list<unsigned> bytes) {
        ByteVector data;
        append(data, bytes);
        return chunk(type, data);
    }

    /// Rows without their filter bytes, at most 65000 bytes in all; then the end.
    ByteVector finish(const std::vector<std::vector<unsigned>>& rows) {
        ByteVector raw;
        for (const std::vector<unsigned>& row : rows) {
            raw.push_back(std::byte{0});
            for (const unsigned byte : row)
                raw.push_back(static_cast<std::byte>(byte));
        }
        uint32_t a = 1;
        uint32_t b = 0;
        for (const std::byte byte : raw) {
            a = (a + std::to_integer<uint32_t>(byte)) % 65521;
            b = (b + a) % 65521;
        }
        const auto size = static_cast<unsigned>(raw.size());
        ByteVector stream;
        append(stream, {0x78, 0x01, 0x01, size, size >> 8, ~size, ~size >> 8});
        std::copy(raw.begin(), raw.end(), std::back_inserter(stream));
        append_big_endian(stream, b << 16 | a);
        chunk("IDAT", stream);
        chunk("IEND", ByteVector());
        return png_;
    }

    const ByteVector& so_far() const { return png_; }

private:
    ByteVector png_;
};

}  // namespace obscura::testing_images
