// image/ktx2.cpp - decodes KTX 2.0 files to straight-alpha RGBA8 with their mip levels.
// SPDX-License-Identifier: Apache-2.0
#include "image/ktx2.h"

#include "image/corrupt.h"
#include "image/uastc.h"

#include <optional>
#include <zstd.h>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;

constexpr uint32_t opaque = 0xFF000000U;
constexpr uint32_t all_channels = ~0U;

/// A stored texel with its channels in RGBA order, as materials read it.
uint32_t as_seen(uint32_t texel, Ktx2Channels channels) {
    const uint32_t red = texel & 0xFFU;
    switch (channels) {
        case Ktx2Channels::rgb:
            return texel | opaque;
        case Ktx2Channels::rgba:
            return texel;
        case Ktx2Channels::red:
            return red | red << 8 | red << 16 | opaque;
        case Ktx2Channels::red_green:
            return (texel & 0xFFFFU) | opaque;
        case Ktx2Channels::red_green_in_alpha:
            return red | texel >> 24 << 8 | opaque;
    }
    return texel;
}

void read_plain(ByteSpan bytes, const Ktx2Header& header, const TexelLevel& level) {
    const size_t count = static_cast<size_t>(level.width) * static_cast<size_t>(level.height);
    const auto step = static_cast<size_t>(header.bytes_per_texel);
    for (size_t i = 0; i < count; ++i) {
        uint32_t texel = 0;
        for (size_t c = 0; c < step; ++c)
            texel |= std::to_integer<uint32_t>(bytes[i * step + c]) << 8 * c;
        level.texels[i] = as_seen(texel, header.channels);
    }
}

/// False: a block is broken.
bool decode_uastc(ByteSpan bytes, const Ktx2Header& header, const TexelLevel& level) {
    const bool srgb = header.encoding == ImageEncoding::srgb;
    TexelBlock block;
    size_t at = 0;
    for (int row = 0; row < level.block_rows(); ++row) {
        for (int column = 0; column < level.block_columns(); ++column, at += uastc_block_bytes) {
            const auto stored = bytes.subspan(at).first<uastc_block_bytes>();
            if (!decode_uastc_block(stored, srgb, block)) return false;
            for (uint32_t& texel : block)
                texel = as_seen(texel, header.channels);
            write_block(level, column, row, block, all_channels);
        }
    }
    return true;
}

/// nullopt: broken, or not of the size that the index says.
std::optional<std::vector<std::byte>> without_zstd(ByteSpan bytes, size_t size) {
    std::vector<std::byte> out(size);
    const size_t written = ZSTD_decompress(out.data(), size, bytes.data(), bytes.size());
    if (ZSTD_isError(written) != 0 || written != size) return std::nullopt;
    return out;
}

Result<void> decode_level(const Ktx2Header& header,
                          int number,
                          const TexelLevel& level,
                          const std::string& where) {
    const std::string name = "level " + std::to_string(number) + " of the KTX2 file";
    ByteSpan bytes = header.level_bytes[static_cast<size_t>(number)];
    std::optional<std::vector<std::byte>> inflated;
    if (header.is_zstd) {
        inflated = without_zstd(bytes, header.plain_bytes(number));
        if (!inflated) return corrupt_image(where, name + ": its Zstandard data are broken");
        bytes = *inflated;
    }
    if (header.coding == Ktx2Coding::plain) {
        read_plain(bytes, header, level);
    } else if (!decode_uastc(bytes, header, level)) {
        return corrupt_image(where, name + " has a UASTC block of no known mode or pattern");
    }
    return {};
}

void warn_of_colors(const Ktx2Header& header, const std::string& where, Log& log) {
    if (header.is_premultiplied) {
        log.warn(where,
                 "the KTX2 file says that its alpha is premultiplied, which glTF forbids; its "
                 "colours are used as they are");
    }
    if (header.has_other_primaries) {
        log.warn(where,
                 "the KTX2 file's colour primaries are not those of sRGB; its colours are used as "
                 "if they were");
    }
}

}  // namespace

Result<ImageRgba8> decode_ktx2(const Ktx2Header& header, const std::string& where, Log& log) {
    warn_of_colors(header, where, log);
    ImageRgba8 image{header.width, header.height, {}, "ktx2", header.levels, header.encoding};
    std::vector<TexelLevel> levels;
    size_t total = 0;
    for (int i = 0; i < header.levels; ++i) {
        levels.push_back({nullptr, header.level_width(i), header.level_height(i)});
        total +=
            static_cast<size_t>(levels.back().width) * static_cast<size_t>(levels.back().height);
    }
    image.texels.assign(total, opaque);
    uint32_t* next = image.texels.data();
    for (TexelLevel& level : levels) {
        level.texels = next;
        next += static_cast<size_t>(level.width) * static_cast<size_t>(level.height);
    }
    Result<void> done;
    if (header.coding == Ktx2Coding::basis_lz) {
        done = decode_basis_lz(header, levels, where);
    } else {
        for (int i = 0; done && i < header.levels; ++i)
            done = decode_level(header, i, levels[static_cast<size_t>(i)], where);
    }
    if (!done) return fail(std::move(done.error()));
    return image;
}

}  // namespace obscura
