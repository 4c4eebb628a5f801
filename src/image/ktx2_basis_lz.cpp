// image/ktx2_basis_lz.cpp - decodes the BasisLZ data of a KTX 2.0 file into mip levels.
// SPDX-License-Identifier: Apache-2.0
#include "image/basis_lz.h"
#include "image/corrupt.h"
#include "image/ktx2.h"
#include "image/little_endian.h"

#include <optional>
#include <utility>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;

constexpr size_t counts_bytes = 20;  // of the global data, before the images' descriptions
constexpr size_t description_bytes = 20;
constexpr uint32_t flag_p_frame = 2;
constexpr uint32_t red_mask = 0xFFU;
constexpr uint32_t green_mask = 0xFF00U;
constexpr uint32_t color_mask = 0xFFFFFFU;
constexpr uint32_t alpha_mask = 0xFF000000U;

struct BasisLz {
    BasisLzCodebooks books;
    BasisLzCodes codes;
};

Result<BasisLz> read_global(const Ktx2Header& header, const std::string& where) {
    const ByteSpan bytes = header.global_bytes;
    const size_t images = static_cast<size_t>(header.levels_in_file) * description_bytes;
    if (bytes.size() < counts_bytes + images) {
        return corrupt_image(where, "the KTX2 file's BasisLZ global data are cut off");
    }
    const uint32_t counts = little_endian_32(bytes, 0);
    const uint32_t endpoint_bytes = little_endian_32(bytes, 4);
    const uint32_t selector_bytes = little_endian_32(bytes, 8);
    uint64_t at = counts_bytes + images;
    const auto endpoint_range = range_of(bytes, at, endpoint_bytes);
    at += endpoint_bytes;
    const auto selector_range = range_of(bytes, at, selector_bytes);
    at += selector_bytes;
    const auto code_range = range_of(bytes, at, little_endian_32(bytes, 12));
    if (!endpoint_range || !selector_range || !code_range) {
        return corrupt_image(where, "the KTX2 file's BasisLZ global data are cut off");
    }
    auto endpoints = read_endpoints(*endpoint_range, counts & 0xFFFF);
    if (!endpoints) return corrupt_image(where, "the KTX2 file's table of endpoints is broken");
    auto selectors = read_selectors(*selector_range, counts >> 16);
    if (!selectors) return corrupt_image(where, "the KTX2 file's table of selectors is broken");
    auto codes = read_slice_codes(*code_range);
    if (!codes) return corrupt_image(where, "the KTX2 file's Huffman tables are broken");
    return BasisLz{{std::move(*endpoints), std::move(*selectors)}, std::move(*codes)};
}

/// Decodes a slice into some channels of a level; false if it is broken.
bool paint_slice(std::optional<ByteSpan> slice,
                 const BasisLz& basis,
                 const TexelLevel& level,
                 uint32_t mask) {
    if (!slice || slice->empty()) return false;
    const auto blocks = read_slice(*slice,
                                   basis.books,
                                   basis.codes,
                                   static_cast<size_t>(level.block_columns()),
                                   static_cast<size_t>(level.block_rows()));
    if (!blocks) return false;
    const BasisLzBlock* next = blocks->data();
    for (int row = 0; row < level.block_rows(); ++row) {
        for (int column = 0; column < level.block_columns(); ++column, ++next) {
            TexelBlock block = decode_etc1s_block(basis.books.endpoints[next->endpoint],
                                                  basis.books.selectors[next->selector]);
            if (mask == alpha_mask) {  // alpha is stored as a grey image
                for (uint32_t& texel : block)
                    texel <<= 16;
            }
            write_block(level, column, row, block, mask);
        }
    }
    return true;
}

}  // namespace

Result<void> decode_basis_lz(const Ktx2Header& header,
                             const std::vector<TexelLevel>& levels,
                             const std::string& where) {
    const Result<BasisLz> basis = read_global(header, where);
    if (!basis) return fail(basis.error());
    const bool is_red_green = header.channels == Ktx2Channels::red_green;
    const bool has_second = is_red_green || header.channels == Ktx2Channels::rgba;
    for (size_t i = 0; i < levels.size(); ++i) {
        const size_t at = counts_bytes + i * description_bytes;
        const auto field = [&](size_t number) {
            return little_endian_32(header.global_bytes, at + 4 * number);
        };
        if ((field(0) & flag_p_frame) != 0) {
            return fail(ExitCode::unsupported,
                        "E-IMG-FEATURE",
                        where,
                        "the KTX2 file is a frame of a video; accepted are still pictures");
        }
        const ByteSpan bytes = header.level_bytes[i];
        const auto first = range_of(bytes, field(1), field(2));
        const auto second = range_of(bytes, field(3), field(4));
        bool painted = paint_slice(first, *basis, levels[i], is_red_green ? red_mask : color_mask);
        if (painted && has_second) {
            painted =
                paint_slice(second, *basis, levels[i], is_red_green ? green_mask : alpha_mask);
        }
        if (!painted) {
            return corrupt_image(where,
                                 "level " + std::to_string(i) +
                                     " of the KTX2 file: its BasisLZ data are cut off or broken");
        }
    }
    return {};
}

}  // namespace obscura
