// image/huffman.h - canonical Huffman codes, as Deflate and BasisLZ store them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/bit_reader.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace obscura {

class HuffmanTable {
public:
    static constexpr int longest_code = 16;

    /// Assigns codes in the order of symbols within each length (RFC 1951, section 3.2.2).
    ///
    /// In      lengths: bits of each symbol's code, 0 to 16; 0: the symbol does not occur
    /// Errors  false: with two symbols or more, the codes leave a gap or overlap
    bool build(std::span<const uint8_t> lengths);

    /// The next symbol; -1 if the bits are no code, as always for a table without symbols.
    int decode(BitReader& bits) const;

private:
    int longest_ = 0;
    std::vector<uint32_t> entries_;  ///< by the next `longest_` bits: symbol << 8 | length
};

/// Reads a table as BasisLZ stores it: code lengths, run-length and Huffman coded.
///
/// Errors  nullopt: cut off or contradictory
/// Source  KTX 2.0, appendix "BasisLZ/ETC1S Bitstream Specification", Compressed Huffman Tables
std::optional<HuffmanTable> read_huffman_table(BitReader& bits);

}  // namespace obscura
