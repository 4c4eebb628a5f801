// image/huffman.cpp - canonical Huffman codes, as Deflate and BasisLZ store them.
// SPDX-License-Identifier: Apache-2.0
#include "image/huffman.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

/// Reverses a code, because its first bit is the lowest in the stream.
uint32_t reversed(uint32_t code, int length) {
    uint32_t out = 0;
    for (int i = 0; i < length; ++i)
        out |= (code >> i & 1U) << (length - 1 - i);
    return out;
}

/// The meaning of a symbol among a table's code lengths.
struct LengthRun {
    bool repeats;  ///< the last length, else 0
    uint32_t least;
    int extra_bits;
};

constexpr int first_run_symbol = 17;
constexpr LengthRun length_runs[] = {{false, 3, 3}, {false, 11, 7}, {true, 3, 2}, {true, 7, 7}};

/// The order in which the lengths of the length codes are stored: the likely ones first.
constexpr std::array<uint8_t, 21> length_code_order = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                       11, 4,  12, 3,  13, 2, 14, 1, 15, 16};

std::optional<HuffmanTable> read_length_codes(BitReader& bits) {
    const uint32_t count = bits.read(5);
    if (count == 0 || count > length_code_order.size()) return std::nullopt;
    std::array<uint8_t, length_code_order.size()> lengths = {};
    for (size_t i = 0; i < count; ++i)
        lengths[length_code_order[i]] = static_cast<uint8_t>(bits.read(3));
    HuffmanTable table;
    if (!table.build(lengths)) return std::nullopt;
    return table;
}

}  // namespace

bool HuffmanTable::build(std::span<const uint8_t> lengths) {
    longest_ = 0;
    entries_.clear();
    std::array<uint32_t, longest_code + 1> count = {};
    for (const uint8_t length : lengths) {
        if (length > longest_code) return false;
        ++count[length];
    }
    count[0] = 0;
    uint32_t used = 0, filled = 0;
    std::array<uint32_t, longest_code + 1> next_code = {};
    for (size_t length = 1; length <= longest_code; ++length) {
        next_code[length] = (next_code[length - 1] + count[length - 1]) << 1;
        filled += count[length] << (longest_code - length);
        used += count[length];
        if (count[length] > 0) longest_ = static_cast<int>(length);
    }
    if (used == 0) return true;
    if (filled > 1U << longest_code || (used > 1 && filled < 1U << longest_code)) return false;
    entries_.assign(size_t{1} << longest_, 0);
    for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        const int length = lengths[symbol];
        if (length == 0) continue;
        const size_t step = size_t{1} << length;
        const uint32_t entry = static_cast<uint32_t>(symbol) << 8 | static_cast<uint32_t>(length);
        const uint32_t code = next_code[static_cast<size_t>(length)]++;
        for (size_t i = reversed(code, length); i < entries_.size(); i += step)
            entries_[i] = entry;
    }
    return true;
}

int HuffmanTable::decode(BitReader& bits) const {
    if (entries_.empty()) return -1;
    const uint32_t entry = entries_[bits.peek(longest_)];
    if (entry == 0) return -1;
    bits.skip(static_cast<int>(entry & 0xFF));
    return static_cast<int>(entry >> 8);
}

std::optional<HuffmanTable> read_huffman_table(BitReader& bits) {
    const size_t count = bits.read(14);
    HuffmanTable table;
    if (count == 0) return table;
    const std::optional<HuffmanTable> length_codes = read_length_codes(bits);
    if (!length_codes) return std::nullopt;
    std::vector<uint8_t> lengths;
    lengths.reserve(count);
    while (lengths.size() < count) {
        const int symbol = length_codes->decode(bits);
        if (symbol < 0 || bits.overran()) return std::nullopt;
        if (symbol < first_run_symbol) {
            lengths.push_back(static_cast<uint8_t>(symbol));
            continue;
        }
        const LengthRun& run = length_runs[symbol - first_run_symbol];
        const size_t times = run.least + bits.read(run.extra_bits);
        const uint8_t last = lengths.empty() ? uint8_t{0} : lengths.back();
        if (times > count - lengths.size() || (run.repeats && last == 0)) return std::nullopt;
        lengths.insert(lengths.end(), times, run.repeats ? last : uint8_t{0});
    }
    if (bits.overran() || !table.build(lengths)) return std::nullopt;
    return table;
}

}  // namespace obscura
