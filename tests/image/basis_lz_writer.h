// tests/image/basis_lz_writer.h - BasisLZ's parts with the plainest Huffman codes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/bit_writer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace obscura::testing_images {

/// A symbol of a code whose 2^bits words are all `bits` long and count upwards.
inline void put_flat(BitWriter& out, uint32_t symbol, int bits) {
    for (int i = bits; i-- > 0;)
        out.put(symbol >> i, 1);
}

/// Stores lengths of codes, up to 15, one by one in four bits each.
inline void put_code_lengths(BitWriter& out, const std::vector<int>& lengths) {
    constexpr int length_codes = 21, longest = 16;
    static constexpr int order[length_codes] = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
    out.put(lengths.size(), 14);
    out.put(length_codes, 5);
    for (const int symbol : order)  // lengths 0 to 15 get codes of four bits
        out.put(symbol < longest ? 4 : 0, 3);
    for (const int length : lengths)
        put_flat(out, static_cast<uint32_t>(length), 4);
}

/// The table of put_flat's code.
inline void put_flat_table(BitWriter& out, int bits) {
    put_code_lengths(out, std::vector<int>(size_t{1} << bits, bits));
}

/// A number in chunks, as runs are stored.
inline void put_chunked(BitWriter& out, uint32_t value, int chunk) {
    for (; value >> chunk != 0; value >>= chunk)
        out.put((value & ((1U << chunk) - 1)) | 1U << chunk, chunk + 1);
    out.put(value, chunk + 1);
}

}  // namespace obscura::testing_images
