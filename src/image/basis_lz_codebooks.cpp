// image/basis_lz_codebooks.cpp - reads the codebooks and Huffman codes that all slices share.
// SPDX-License-Identifier: Apache-2.0
#include "image/basis_lz.h"

#include <array>
#include <utility>

namespace obscura {

namespace {

constexpr int history_size_bits = 13;

/// The code of a colour difference depends on the brightness of the previous colour.
size_t delta_code_for(uint8_t before) {
    return before < 10 ? 0 : before < 22 ? 1 : 2;
}

/// Adds a stored difference to `before`, modulo `mask` + 1; false: invalid code.
bool read_delta(BitReader& bits, const HuffmanTable& code, uint8_t mask, uint8_t& before) {
    const int delta = code.decode(bits);
    if (delta < 0) return false;
    before = static_cast<uint8_t>((before + delta) & mask);
    return true;
}

}  // namespace

std::optional<std::vector<Etc1sEndpoint>> read_endpoints(std::span<const std::byte> bytes,
                                                         size_t count) {
    BitReader bits(bytes);
    std::array<HuffmanTable, 4> codes;  // three of colours, one of tables
    for (HuffmanTable& code : codes) {
        std::optional<HuffmanTable> read = read_huffman_table(bits);
        if (!read) return std::nullopt;
        code = std::move(*read);
    }
    const bool is_grey = bits.read(1) != 0;
    std::vector<Etc1sEndpoint> endpoints(count);
    Etc1sEndpoint last{16, 16, 16, 0};
    for (Etc1sEndpoint& endpoint : endpoints) {
        if (!read_delta(bits, codes[3], 7, last.table)) return std::nullopt;
        for (uint8_t* channel : {&last.red, &last.green, &last.blue}) {
            if (!read_delta(bits, codes[delta_code_for(*channel)], 31, *channel)) {
                return std::nullopt;
            }
            if (is_grey) break;
        }
        if (is_grey) last.green = last.blue = last.red;
        if (bits.overran()) return std::nullopt;
        endpoint = last;
    }
    return endpoints;
}

std::optional<std::vector<Etc1sSelectors>> read_selectors(std::span<const std::byte> bytes,
                                                          size_t count) {
    BitReader bits(bytes);
    if (bits.read(2) != 0) return std::nullopt;  // reserved
    const bool is_raw = bits.read(1) != 0;
    HuffmanTable code;
    if (!is_raw) {
        std::optional<HuffmanTable> read = read_huffman_table(bits);
        if (!read) return std::nullopt;
        code = std::move(*read);
    }
    std::vector<Etc1sSelectors> selectors(count);
    for (size_t i = 0; i < count; ++i) {
        for (int shift = 0; shift < 32; shift += 8) {
            if (is_raw || i == 0) {
                selectors[i] |= bits.read(8) << shift;
                continue;
            }
            const int change = code.decode(bits);
            if (change < 0 || change > 0xFF) return std::nullopt;
            const uint32_t before = selectors[i - 1] >> shift & 0xFFU;
            selectors[i] |= (before ^ static_cast<uint32_t>(change)) << shift;
        }
        if (bits.overran()) return std::nullopt;
    }
    return selectors;
}

std::optional<BasisLzCodes> read_slice_codes(std::span<const std::byte> bytes) {
    BitReader bits(bytes);
    BasisLzCodes codes;
    for (HuffmanTable* code : {&codes.endpoint_prediction,
                               &codes.endpoint_delta,
                               &codes.selector,
                               &codes.selector_run}) {
        std::optional<HuffmanTable> read = read_huffman_table(bits);
        if (!read) return std::nullopt;
        *code = std::move(*read);
    }
    codes.history_size = bits.read(history_size_bits);
    if (bits.overran()) return std::nullopt;
    return codes;
}

}  // namespace obscura
