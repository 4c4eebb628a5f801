// image/ktx2_header.cpp - reads header, index and data format descriptor of a KTX 2.0 file.
// SPDX-License-Identifier: Apache-2.0
#include "image/ktx2_header.h"

#include "image/corrupt.h"
#include "image/image_header.h"
#include "image/little_endian.h"
#include "image/texel_block.h"
#include "image/uastc.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;

constexpr std::string_view identifier("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr size_t header_bytes = 80;
constexpr size_t level_entry_bytes = 24;

/// Byte offsets of the header's fields.
enum Field : size_t {
    at_vk_format = 12,
    at_width = 20,
    at_height = 24,
    at_depth = 28,
    at_layers = 32,
    at_faces = 36,
    at_levels = 40,
    at_supercompression = 44,
    at_description = 48,  // offset and length, as are the next two
    at_key_values = 56,
    at_global = 64,  // in 64 bits
};

enum Supercompression : uint32_t { no_supercompression = 0, basis_lz = 1, zstandard = 2 };

// Khronos Data Format: colour models, transfer functions, primaries, flags.
constexpr uint32_t model_etc1s = 163;
constexpr uint32_t model_uastc = 166;
constexpr uint32_t transfer_linear = 1;
constexpr uint32_t transfer_srgb = 2;
constexpr uint32_t primaries_of_srgb = 1;
constexpr uint32_t flag_premultiplied = 1;

tl::unexpected<Error> unsupported(const std::string& where, const std::string& why) {
    return fail(ExitCode::unsupported, "E-IMG-FEATURE", where, why);
}

Result<void> read_shape(ByteSpan bytes, Ktx2Header& header, const std::string& where) {
    const int64_t width = little_endian_32(bytes, at_width);
    const int64_t height = little_endian_32(bytes, at_height);
    const uint32_t faces = little_endian_32(bytes, at_faces);
    const char* shape = little_endian_32(bytes, at_depth) != 0    ? "a 3D texture"
                        : faces == 6                              ? "a cube map"
                        : little_endian_32(bytes, at_layers) != 0 ? "an array of pictures"
                        : height == 0 && width > 0                ? "a 1D texture"
                                                                  : nullptr;
    if (shape != nullptr) {
        return unsupported(where,
                           std::string("the KTX2 file is ") + shape + "; accepted are 2D pictures");
    }
    if (faces != 1) {
        return corrupt_image(where, "the KTX2 file has " + std::to_string(faces) + " faces");
    }
    if (auto fits = check_image_size(width, height, sizeof(uint32_t), "E-IMG", where); !fits) {
        return fits;
    }
    header.width = static_cast<int>(width);
    header.height = static_cast<int>(height);
    const uint32_t levels = std::max(little_endian_32(bytes, at_levels), 1U);
    const auto max_levels = static_cast<uint32_t>(
        std::bit_width(static_cast<uint32_t>(std::max(header.width, header.height))));
    if (levels > max_levels) {
        return corrupt_image(where,
                             "the KTX2 file has " + std::to_string(levels) +
                                 " levels; its size allows " + std::to_string(max_levels));
    }
    header.levels = static_cast<int>(levels);
    header.levels_in_file = header.levels;
    return {};
}

/// The basic block of the data format descriptor.
struct Description {
    uint32_t model = 0;
    uint32_t primaries = 0;
    uint32_t transfer = 0;
    uint32_t flags = 0;
    uint32_t first_channel = 0;
    uint32_t second_channel = 0;
    size_t samples = 0;
};

Result<Description> read_description(ByteSpan bytes, const std::string& where) {
    constexpr size_t total_and_block = 4 + 24, sample_bytes = 16, channel_at = 3;
    const auto found = range_of(bytes,
                                little_endian_32(bytes, at_description),
                                little_endian_32(bytes, at_description + 4));
    if (!found || found->size() < total_and_block) {
        return corrupt_image(where, "the KTX2 file's data format descriptor is cut off");
    }
    const size_t block_bytes = little_endian_32(*found, 8) >> 16;
    if (little_endian_32(*found, 4) != 0 || block_bytes < 24 || block_bytes > found->size() - 4) {
        return corrupt_image(where, "the KTX2 file's data format descriptor is broken");
    }
    const uint32_t colors = little_endian_32(*found, 12);
    Description out;
    out.model = colors & 0xFF;
    out.primaries = colors >> 8 & 0xFF;
    out.transfer = colors >> 16 & 0xFF;
    out.flags = colors >> 24;
    out.samples = (block_bytes - 24) / sample_bytes;
    const auto channel = [&](size_t sample) {
        const size_t at = total_and_block + sample * sample_bytes + channel_at;
        return sample < out.samples ? std::to_integer<uint32_t>((*found)[at]) & 0xFU : 0U;
    };
    out.first_channel = channel(0);
    out.second_channel = channel(1);
    return out;
}

std::optional<Ktx2Channels> etc1s_channels(const Description& description) {
    enum : uint32_t { in_rgb = 0, in_red = 3, in_green = 4, in_alpha = 15 };
    const bool two = description.samples == 2;
    const uint32_t first = description.first_channel, second = description.second_channel;
    if (description.samples == 1 && first == in_rgb) return Ktx2Channels::rgb;
    if (description.samples == 1 && first == in_red) return Ktx2Channels::red;
    if (two && first == in_rgb && second == in_alpha) return Ktx2Channels::rgba;
    if (two && first == in_red && second == in_green) return Ktx2Channels::red_green;
    return std::nullopt;
}

std::optional<Ktx2Channels> uastc_channels(const Description& description) {
    if (description.samples != 1) return std::nullopt;
    switch (description.first_channel) {
        case 0:
            return Ktx2Channels::rgb;
        case 3:
            return Ktx2Channels::rgba;
        case 4:
            return Ktx2Channels::red;
        case 5:
            return Ktx2Channels::red_green_in_alpha;
        case 6:
            return Ktx2Channels::red_green;
        default:
            return std::nullopt;
    }
}

/// ByteSpan per texel of an uncompressed format; 0: not supported.
int plain_texel_bytes(uint32_t vk_format) {
    switch (vk_format) {  // of each the UNORM and the SRGB format
        case 9:
        case 15:
            return 1;  // R8
        case 16:
        case 22:
            return 2;  // R8G8
        case 23:
        case 29:
            return 3;  // R8G8B8
        case 37:
        case 43:
            return 4;  // R8G8B8A8
        default:
            return 0;
    }
}

Result<void> read_coding(ByteSpan bytes, Ktx2Header& header, const std::string& where) {
    const Result<Description> description = read_description(bytes, where);
    if (!description) return fail(description.error());
    header.is_premultiplied = (description->flags & flag_premultiplied) != 0;
    header.has_other_primaries = description->primaries > primaries_of_srgb;
    header.encoding = description->transfer == transfer_linear ? ImageEncoding::linear
                      : description->transfer == transfer_srgb ? ImageEncoding::srgb
                                                               : ImageEncoding::unsaid;
    const uint32_t format = little_endian_32(bytes, at_vk_format);
    const uint32_t scheme = little_endian_32(bytes, at_supercompression);
    header.is_zstd = scheme == zstandard;
    const bool is_plain_or_zstd = scheme == no_supercompression || header.is_zstd;
    std::optional<Ktx2Channels> channels;
    if (format == 0 && description->model == model_etc1s && scheme == basis_lz) {
        header.coding = Ktx2Coding::basis_lz;
        channels = etc1s_channels(*description);
    } else if (format == 0 && description->model == model_uastc && is_plain_or_zstd) {
        header.coding = Ktx2Coding::uastc;
        channels = uastc_channels(*description);
    } else if (const int texel_bytes = plain_texel_bytes(format);
               texel_bytes != 0 && is_plain_or_zstd) {
        constexpr Ktx2Channels by_bytes[] = {
            Ktx2Channels::red, Ktx2Channels::red_green, Ktx2Channels::rgb, Ktx2Channels::rgba};
        header.bytes_per_texel = texel_bytes;
        channels = by_bytes[texel_bytes - 1];
    } else {
        return unsupported(where,
                           "the KTX2 file has Vulkan format " + std::to_string(format) +
                               ", colour model " + std::to_string(description->model) +
                               " and supercompression " + std::to_string(scheme) +
                               "; accepted are ETC1S with BasisLZ, and UASTC or 8 bits a channel "
                               "with Zstandard or none");
    }
    if (!channels) return unsupported(where, "the KTX2 file's channels are none that glTF allows");
    header.channels = *channels;
    return {};
}

/// The text of an entry without the terminating 0; nullopt: the entries are truncated.
std::optional<std::string_view> find_value(ByteSpan entries, std::string_view key) {
    while (!entries.empty()) {
        const auto size = range_of(entries, 0, 4);
        const auto entry = size ? range_of(entries, 4, little_endian_32(*size, 0)) : std::nullopt;
        if (!entry) return std::nullopt;
        const std::string_view text(reinterpret_cast<const char*>(entry->data()), entry->size());
        const size_t key_end = std::min(text.find('\0'), text.size());
        if (text.substr(0, key_end) == key) {
            const std::string_view value = text.substr(std::min(key_end + 1, text.size()));
            return value.substr(0, value.find('\0'));
        }
        const size_t padded = 4 + (entry->size() + 3) / 4 * 4;
        entries = entries.subspan(std::min(padded, entries.size()));
    }
    return std::string_view();
}

Result<void> check_key_values(ByteSpan bytes, const std::string& where) {
    const auto entries = range_of(
        bytes, little_endian_32(bytes, at_key_values), little_endian_32(bytes, at_key_values + 4));
    constexpr std::pair<const char*, const char*> expected[] = {{"KTXorientation", "rd"},
                                                                {"KTXswizzle", "rgba"}};
    for (const auto& [key, accepted] : expected) {
        const auto value = entries ? find_value(*entries, key) : std::nullopt;
        if (!value) return corrupt_image(where, "the KTX2 file's key/value data are cut off");
        if (value->empty() || *value == accepted) continue;
        return unsupported(where,
                           std::string("the KTX2 file's ") + key + " is \"" +
                               std::string(value->substr(0, 16)) + "\"; accepted is \"" + accepted +
                               "\"");
    }
    return {};
}

Result<void> find_level(ByteSpan bytes, int level, Ktx2Header& header, const std::string& where) {
    const size_t entry = header_bytes + level_entry_bytes * static_cast<size_t>(level);
    const std::string name = "level " + std::to_string(level) + " of the KTX2 file";
    if (entry + level_entry_bytes > bytes.size()) return corrupt_image(where, name + " is cut off");
    const uint64_t length = little_endian_64(bytes, entry + 8);
    const auto found = range_of(bytes, little_endian_64(bytes, entry), length);
    if (!found) return corrupt_image(where, name + " is cut off");
    header.level_bytes[static_cast<size_t>(level)] = *found;
    if (header.coding == Ktx2Coding::basis_lz) return {};
    const uint64_t wanted = header.plain_bytes(level);
    const uint64_t stated = header.is_zstd ? little_endian_64(bytes, entry + 16) : length;
    constexpr uint64_t best_zstd_compression = 32768;  // blocks of 128 KiB, told in 4 bytes
    if (stated != wanted || length < wanted / best_zstd_compression) {
        return corrupt_image(where,
                             name + " has " + std::to_string(stated) + " bytes, stored in " +
                                 std::to_string(length) + "; its size asks for " +
                                 std::to_string(wanted));
    }
    return {};
}

}  // namespace

size_t Ktx2Header::plain_bytes(int level) const {
    const auto level_columns = static_cast<size_t>(level_width(level));
    const auto level_rows = static_cast<size_t>(level_height(level));
    if (coding == Ktx2Coding::plain) {
        return level_columns * level_rows * static_cast<size_t>(bytes_per_texel);
    }
    return TexelLevel{nullptr, level_width(level), level_height(level)}.block_count() *
           uastc_block_bytes;
}

bool is_ktx2(ByteSpan bytes) {
    return bytes.size() >= identifier.size() &&
           std::memcmp(bytes.data(), identifier.data(), identifier.size()) == 0;
}

Result<Ktx2Header> read_ktx2_header(ByteSpan bytes, const std::string& where) {
    if (bytes.size() < header_bytes) return corrupt_image(where, "the KTX2 header is cut off");
    Ktx2Header header;
    Result<void> done = read_shape(bytes, header, where);
    if (done) done = read_coding(bytes, header, where);
    if (done) done = check_key_values(bytes, where);
    for (int level = 0; done && level < header.levels; ++level)
        done = find_level(bytes, level, header, where);
    if (!done) return fail(std::move(done.error()));
    const auto global =
        range_of(bytes, little_endian_64(bytes, at_global), little_endian_64(bytes, at_global + 8));
    if (!global) return corrupt_image(where, "the KTX2 file's global data are cut off");
    header.global_bytes = *global;
    return header;
}

}  // namespace obscura
