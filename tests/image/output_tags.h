// tests/image/output_tags.h - takes encoded images apart by the formats' specifications.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/png_builder.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace obscura::testing_images {

inline uint32_t big_endian(const ByteVector& bytes, size_t at, size_t count) {
    uint32_t value = 0;
    for (size_t i = 0; i < count; ++i)
        value = value << 8 | std::to_integer<uint32_t>(bytes.at(at + i));
    return value;
}

inline uint32_t little_endian(const ByteVector& bytes, size_t at, size_t count) {
    uint32_t value = 0;
    for (size_t i = count; i-- > 0;)
        value = value << 8 | std::to_integer<uint32_t>(bytes.at(at + i));
    return value;
}

inline ByteVector slice(const ByteVector& bytes, size_t at, size_t count) {
    if (at + count > bytes.size()) return {};
    return ByteVector(bytes.begin() + static_cast<long>(at),
                      bytes.begin() + static_cast<long>(at + count));
}

inline std::string text_at(const ByteVector& bytes, size_t at, size_t count) {
    std::string text;
    for (const std::byte byte : slice(bytes, at, count))
        text += static_cast<char>(byte);
    return text;
}

struct Chunk {
    std::string type;
    ByteVector data;
};

/// All chunks of a PNG, in order; those whose checksum is wrong are called "broken".
inline std::vector<Chunk> png_chunks(const ByteVector& png) {
    std::vector<Chunk> chunks;
    for (size_t at = 8; at + 12 <= png.size();) {
        const size_t length = big_endian(png, at, 4);
        const bool sound =
            big_endian(png, at + 8 + length, 4) == crc32(png.data() + at + 4, length + 4);
        chunks.push_back({sound ? text_at(png, at + 4, 4) : "broken", slice(png, at + 8, length)});
        at += length + 12;
    }
    return chunks;
}

/// The top-level chunks of a WebP.
inline std::vector<Chunk> webp_chunks(const ByteVector& webp) {
    std::vector<Chunk> chunks;
    if (text_at(webp, 0, 4) != "RIFF" || little_endian(webp, 4, 4) + 8 != webp.size()) return {};
    for (size_t at = 12; at + 8 <= webp.size();) {
        const size_t length = little_endian(webp, at + 4, 4);
        chunks.push_back({text_at(webp, at, 4), slice(webp, at + 8, length)});
        at += 8 + length + length % 2;
    }
    return chunks;
}

/// The data of one kind of chunk; empty: there is none.
inline ByteVector data_of(const std::vector<Chunk>& chunks, std::string_view type) {
    for (const Chunk& chunk : chunks) {
        if (chunk.type == type) return chunk.data;
    }
    return {};
}

inline std::vector<std::string> types_of(const std::vector<Chunk>& chunks) {
    std::vector<std::string> types;
    for (const Chunk& chunk : chunks)
        types.push_back(chunk.type);
    return types;
}

/// The profile of a JPEG's APP2 segments, of which a small one needs one; empty: there is none.
inline ByteVector jpeg_profile(const ByteVector& jpeg) {
    const std::string mark("ICC_PROFILE\0\1\1", 14);
    for (size_t at = 2; at + 4 <= jpeg.size() && big_endian(jpeg, at, 2) != 0xFFDA;) {
        const size_t length = big_endian(jpeg, at + 2, 2);
        if (big_endian(jpeg, at, 2) == 0xFFE2 && text_at(jpeg, at + 4, 14) == mark) {
            return slice(jpeg, at + 18, length - 16);
        }
        at += 2 + length;
    }
    return {};
}

/// The values of a tag of a little-endian TIFF's first directory: of bytes, shorts or longs; a
/// single value that fits stands in the directory itself.
inline std::vector<uint32_t> tiff_tag(const ByteVector& tiff, uint32_t tag) {
    if (text_at(tiff, 0, 2) != "II") return {};
    const size_t directory = little_endian(tiff, 4, 4);
    const uint32_t entries = little_endian(tiff, directory, 2);
    for (uint32_t i = 0; i < entries; ++i) {
        const size_t at = directory + 2 + 12 * i;
        if (little_endian(tiff, at, 2) != tag) continue;
        const uint32_t type = little_endian(tiff, at + 2, 2);
        const size_t size = type == 3 ? 2 : type == 4 ? 4 : 1;
        const uint32_t count = little_endian(tiff, at + 4, 4);
        const size_t begin = count * size <= 4 ? at + 8 : little_endian(tiff, at + 8, 4);
        std::vector<uint32_t> values;
        for (uint32_t k = 0; k < count; ++k)
            values.push_back(little_endian(tiff, begin + k * size, size));
        return values;
    }
    return {};
}

inline ByteVector bytes_of(const std::vector<uint32_t>& values) {
    ByteVector out;
    for (const uint32_t value : values)
        out.push_back(static_cast<std::byte>(value));
    return out;
}

/// The elements of an ICC profile by their tags.
inline std::map<std::string, ByteVector> profile_elements(const ByteVector& profile) {
    std::map<std::string, ByteVector> elements;
    for (uint32_t i = 0; i < big_endian(profile, 128, 4); ++i) {
        const size_t at = 132 + size_t{12} * i;
        elements[text_at(profile, at, 4)] =
            slice(profile, big_endian(profile, at + 4, 4), big_endian(profile, at + 8, 4));
    }
    return elements;
}

/// Numbers in the format s15Fixed16 behind an element's eight first bytes.
inline std::vector<double> fixed_numbers(const ByteVector& element, size_t from = 8) {
    std::vector<double> numbers;
    for (size_t at = from; at + 4 <= element.size(); at += 4)
        numbers.push_back(static_cast<int32_t>(big_endian(element, at, 4)) / 65536.0);
    return numbers;
}

}  // namespace obscura::testing_images
