// image/image_header.cpp - reads the header of an encoded image without decoding it.
// SPDX-License-Identifier: Apache-2.0
#include "image/image_header.h"

#include "image/corrupt.h"
#include "image/ktx2_header.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <webp/decode.h>

namespace obscura {

namespace {

constexpr int64_t longest_side = 65536;
constexpr int64_t max_bytes = int64_t{1} << 31;
constexpr int max_jpeg_scans = 1000;

using ByteSpan = std::span<const std::byte>;

bool starts_with(ByteSpan bytes, std::string_view text, size_t at = 0) {
    return bytes.size() >= at + text.size() &&
           std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

uint32_t byte_at(ByteSpan bytes, size_t at) {
    return std::to_integer<uint32_t>(bytes[at]);
}

uint32_t big_endian_16(ByteSpan bytes, size_t at) {
    return byte_at(bytes, at) << 8 | byte_at(bytes, at + 1);
}

uint32_t big_endian_32(ByteSpan bytes, size_t at) {
    return big_endian_16(bytes, at) << 16 | big_endian_16(bytes, at + 2);
}

/// The probable format of the first bytes, for messages.
const char* looks_like(ByteSpan bytes) {
    struct Magic {
        size_t at;
        std::string_view text;
        const char* name;
    };
    static constexpr Magic known[] = {
        {0, std::string_view("\xABKTX 20", 7), "KTX2, damaged"},
        {0, std::string_view("\xABKTX 11", 7), "KTX"},
        {0, "DDS ", "DDS"},
        {0, "GIF8", "GIF"},
        {0, "BM", "BMP"},
        {0, std::string_view("II*\0", 4), "TIFF"},
        {0, std::string_view("MM\0*", 4), "TIFF"},
        {0, "8BPS", "Photoshop"},
        {0, "v/1\x01", "OpenEXR"},
        {0, "#?", "Radiance HDR"},
        {4, "ftypavif", "AVIF"},
        {4, "ftyphei", "HEIF"},
        {0, std::string_view("\xFF\x0A", 2), "JPEG XL"},
        {4, std::string_view("JXL ", 4), "JPEG XL"},
        {4, std::string_view("jP  ", 4), "JPEG 2000"},
        {0, "<svg", "SVG"},
        {0, "<?xml", "XML or SVG"},
        {0, "<!DOCTYPE", "HTML"},
        {0, "<html", "HTML"},
        {0, "version https://git-lfs", "a Git LFS pointer, not the file itself"},
    };
    for (const Magic& magic : known) {
        if (starts_with(bytes, magic.text, magic.at)) return magic.name;
    }
    return bytes.empty() ? "an empty file" : "an unknown format";
}

/// Refuses files that are too short for the image size in their header, before it is allocated.
Result<void> check_enough_data(ByteSpan bytes, int64_t min_bytes, const std::string& where) {
    if (static_cast<int64_t>(bytes.size()) >= min_bytes) return {};
    return corrupt_image(
        where,
        std::to_string(bytes.size()) +
            " bytes cannot hold a picture of the size in its header: it is cut off");
}

/// ByteSpan of one PNG row before compression, its filter byte included.
int64_t png_row_bytes(ByteSpan bytes, int64_t width) {
    const int64_t bits = byte_at(bytes, 24);
    const uint32_t color_type = byte_at(bytes, 25);
    const int64_t channels = color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1;
    return 1 + (width * channels * bits + 7) / 8;
}

Result<ImageHeader> read_png(ByteSpan bytes, const std::string& where) {
    constexpr size_t signature = 8;
    if (bytes.size() < signature + 25 || !starts_with(bytes, "IHDR", signature + 4)) {
        return corrupt_image(where, "the PNG header is cut off or is not first");
    }
    ImageHeader header{ImageFormat::png};
    const int64_t width = big_endian_32(bytes, signature + 8);
    const int64_t height = big_endian_32(bytes, signature + 12);
    if (auto fits = check_image_size(width, height, 4, "E-IMG", where); !fits) {
        return fail(std::move(fits.error()));
    }
    constexpr int64_t best_compression = 1032;  // of the deflate method
    const int64_t min_bytes = png_row_bytes(bytes, width) * height / best_compression;
    if (auto enough = check_enough_data(bytes, min_bytes, where); !enough) {
        return fail(std::move(enough.error()));
    }
    header.width = static_cast<int>(width);
    header.height = static_cast<int>(height);
    header.bits = byte_at(bytes, 24) == 16 ? 16 : 8;
    for (size_t at = signature; !starts_with(bytes, "IEND", at + 4);) {
        constexpr size_t length_type_checksum = 12;
        const size_t left = bytes.size() - at;
        const size_t length = left < length_type_checksum ? left : big_endian_32(bytes, at);
        if (length + length_type_checksum > left) {
            return corrupt_image(where, "the PNG is cut off: its last chunk, IEND, is not there");
        }
        if (starts_with(bytes, "acTL", at + 4)) header.animated = true;
        at += length + length_type_checksum;
    }
    return header;
}

bool is_start_of_frame(uint32_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Reads the frame header of an 8-bit JPEG: baseline, extended or progressive, in either coding.
Result<ImageHeader> read_jpeg_frame(ByteSpan frame, uint32_t marker, const std::string& where) {
    if (frame.size() < 8) return corrupt_image(where, "the JPEG frame header is cut off");
    const bool read = marker <= 0xC2 || marker == 0xC9 || marker == 0xCA;
    const uint32_t bits = byte_at(frame, 2);
    if (!read || bits != 8) {
        return fail(ExitCode::unsupported,
                    "E-IMG-FEATURE",
                    where,
                    !read ? "a lossless or hierarchical JPEG; save it as baseline or progressive"
                          : "a JPEG with " + std::to_string(bits) +
                                " bits a channel; save it with 8 bits or as PNG");
    }
    const int64_t width = big_endian_16(frame, 5);
    const int64_t height = big_endian_16(frame, 3);
    if (auto fits = check_image_size(width, height, 4, "E-IMG", where); !fits) {
        return fail(std::move(fits.error()));
    }
    return ImageHeader{ImageFormat::jpeg, static_cast<int>(width), static_cast<int>(height), false};
}

/// The number of scans after `at`, counted up to just above the limit.
int count_scans(ByteSpan bytes, size_t at) {
    int scans = 0;
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    while (scans <= max_jpeg_scans && at + 1 < bytes.size()) {
        const void* found = std::memchr(data + at, 0xFF, bytes.size() - 1 - at);
        if (!found) break;
        at = static_cast<size_t>(static_cast<const unsigned char*>(found) - data) + 1;
        if (data[at] == 0xDA) ++scans;
    }
    return scans;
}

Result<ImageHeader> read_jpeg(ByteSpan bytes, const std::string& where) {
    for (size_t at = 2; at + 4 <= bytes.size();) {
        if (byte_at(bytes, at) != 0xFF) {
            ++at;  // a stray byte between two segments; decoders skip them
            continue;
        }
        const uint32_t marker = byte_at(bytes, at + 1);
        const bool alone = marker == 0xFF || marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD8);
        if (alone) {
            at += marker == 0xFF ? 1 : 2;
            continue;
        }
        if (marker == 0xDA || marker == 0xD9) {
            return corrupt_image(where, "a JPEG without a frame header before its pixels");
        }
        const size_t length = big_endian_16(bytes, at + 2);
        if (length < 2 || at + 2 + length > bytes.size()) break;
        if (is_start_of_frame(marker)) {
            if (count_scans(bytes, at + 2 + length) > max_jpeg_scans) {
                return fail(ExitCode::refused,
                            "E-IMG-LIMIT",
                            where,
                            "a JPEG of more than 1000 scans would take very long to decode; save "
                            "it again as baseline");
            }
            auto header = read_jpeg_frame(bytes.subspan(at + 2, length), marker, where);
            if (!header || marker > 0xC2) return header;
            // Huffman coding spends at least one bit on each block of 8 x 8 pixels.
            const int64_t min_bytes = int64_t{header->width} * header->height / 512;
            if (auto enough = check_enough_data(bytes, min_bytes, where); !enough) {
                return fail(std::move(enough.error()));
            }
            return header;
        }
        at += 2 + length;
    }
    return corrupt_image(where, "the JPEG is cut off before its frame header");
}

Result<ImageHeader> read_webp(ByteSpan bytes, const std::string& where) {
    WebPBitstreamFeatures features = {};
    const auto status =
        WebPGetFeatures(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &features);
    if (status != VP8_STATUS_OK) {
        return corrupt_image(where,
                             status == VP8_STATUS_NOT_ENOUGH_DATA ? "the WebP header is cut off"
                                                                  : "the WebP header is broken");
    }
    if (auto fits = check_image_size(features.width, features.height, 4, "E-IMG", where); !fits) {
        return fail(std::move(fits.error()));
    }
    return ImageHeader{
        ImageFormat::webp, features.width, features.height, features.has_animation != 0};
}

Result<ImageHeader> read_ktx2(ByteSpan bytes, const std::string& where) {
    const Result<Ktx2Header> header = read_ktx2_header(bytes, where);
    if (!header) return fail(header.error());
    return ImageHeader{
        ImageFormat::ktx2, header->width, header->height, false, header->levels, header->encoding};
}

}  // namespace

const char* format_name(ImageFormat format) {
    switch (format) {
        case ImageFormat::png:
            return "png";
        case ImageFormat::jpeg:
            return "jpeg";
        case ImageFormat::webp:
            return "webp";
        case ImageFormat::ktx2:
            return "ktx2";
    }
    return "";
}

Result<void> check_image_size(int64_t width,
                              int64_t height,
                              int bytes_per_pixel,
                              const std::string& family,
                              const std::string& where) {
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width < 1 || height < 1) {
        return fail(ExitCode::bad_resource,
                    family + "-CORRUPT",
                    where,
                    size + "; at least 1 x 1 is needed");
    }
    if (width <= longest_side && height <= longest_side &&
        width * height <= max_bytes / bytes_per_pixel) {
        return {};
    }
    return fail(ExitCode::refused,
                family + "-LIMIT",
                where,
                size + "; accepted are sides up to " + std::to_string(longest_side) +
                    " and, altogether, " + std::to_string(max_bytes / bytes_per_pixel) + " pixels");
}

Result<ImageHeader> read_image_header(ByteSpan bytes, const std::string& where) {
    if (starts_with(bytes, std::string_view("\x89PNG\r\n\x1A\n", 8))) return read_png(bytes, where);
    if (starts_with(bytes, "\xFF\xD8\xFF")) return read_jpeg(bytes, where);
    if (starts_with(bytes, "RIFF") && starts_with(bytes, "WEBP", 8)) return read_webp(bytes, where);
    if (is_ktx2(bytes)) return read_ktx2(bytes, where);
    return fail(ExitCode::bad_resource,
                "E-IMG-FORMAT",
                where,
                std::string("not a picture that can be read: it looks like ") + looks_like(bytes) +
                    "; accepted are PNG, JPEG, WebP and KTX2");
}

}  // namespace obscura
