// image/uastc.cpp - decodes UASTC LDR 4x4 blocks to texels: 19 modes in one table.
// SPDX-License-Identifier: Apache-2.0
#include "image/uastc.h"

#include "image/uastc_patterns.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace obscura {

namespace {

constexpr size_t max_endpoint_values = 18;  // three subsets of two colours of three channels
constexpr uint32_t alpha_channel = 3;

/// Ranges of stored numbers: packed digits in base 3 or 5, then plain bits.
enum class Range { to_11, to_15, to_31, to_39, to_47, to_159, to_191, to_255 };

struct RangeForm {
    uint32_t base;  ///< 3: trits, 5: quints, 1: none
    int bits;
    int group;          ///< digits that are packed together
    int group_bits[6];  ///< bits of a group, by its number of digits
};

constexpr RangeForm form_of(Range range) {
    constexpr int trits = 5, quints = 3;
    const auto with_trits = [](int bits) { return RangeForm{3, bits, trits, {0, 2, 4, 5, 7, 8}}; };
    const auto with_quints = [](int bits) {
        return RangeForm{5, bits, quints, {0, 3, 5, 7, 0, 0}};
    };
    switch (range) {
        case Range::to_11:
            return with_trits(2);
        case Range::to_39:
            return with_quints(3);
        case Range::to_47:
            return with_trits(4);
        case Range::to_159:
            return with_quints(5);
        case Range::to_191:
            return with_trits(6);
        case Range::to_15:
            return {1, 4, 1, {}};
        case Range::to_31:
            return {1, 5, 1, {}};
        case Range::to_255:
            return {1, 8, 1, {}};
    }
    return {};
}

/// Spreads `bits` bits over `wanted` by repeating them from the top.
constexpr uint32_t repeated(uint32_t value, int bits, int wanted) {
    uint32_t out = 0;
    for (int at = wanted - bits; at > -bits; at -= bits)
        out |= at >= 0 ? value << at : value >> -at;
    return out;
}

/// Source  Khronos Data Format 1.4, ASTC, "Endpoint Unquantization"
constexpr uint32_t unquantized(Range range, uint32_t digit, uint32_t low) {
    const RangeForm form = form_of(range);
    if (form.base == 1) return repeated(low, form.bits, 8);
    const uint32_t a = (low & 1U) != 0 ? 0x1FF : 0;
    const uint32_t x = low >> 1;
    uint32_t b = 0, c = 0;
    switch (range) {
        case Range::to_11:
            b = x * 0b100010110U;
            c = 93;
            break;
        case Range::to_39:
            b = x << 7 | x << 1 | x >> 1;
            c = 26;
            break;
        case Range::to_47:
            b = x << 6 | x;
            c = 22;
            break;
        case Range::to_159:
            b = x << 5 | x >> 3;
            c = 6;
            break;
        default:
            b = x << 4 | x >> 4;
            c = 5;
            break;
    }
    return (a & 0x80U) | (((digit * c + b) ^ a) >> 2);
}

using ByteTable = std::array<uint8_t, 256>;

/// The table of unquantized values, indexed by digit << bits | low bits.
constexpr ByteTable unquantize_table(Range range) {
    const RangeForm form = form_of(range);
    ByteTable table = {};
    for (uint32_t digit = 0; digit < form.base; ++digit) {
        for (uint32_t low = 0; low < 1U << form.bits; ++low) {
            table[digit << form.bits | low] = static_cast<uint8_t>(unquantized(range, digit, low));
        }
    }
    return table;
}

constexpr std::array<ByteTable, 8> unquantize_tables = {unquantize_table(Range::to_11),
                                                        unquantize_table(Range::to_15),
                                                        unquantize_table(Range::to_31),
                                                        unquantize_table(Range::to_39),
                                                        unquantize_table(Range::to_47),
                                                        unquantize_table(Range::to_159),
                                                        unquantize_table(Range::to_191),
                                                        unquantize_table(Range::to_255)};

/// Weights of `bits` bits on 0..64 (ASTC, "Weight Unquantization").
constexpr std::array<uint8_t, 32> weight_table(int bits) {
    std::array<uint8_t, 32> table = {};
    for (uint32_t i = 0; i < 1U << bits; ++i) {
        const uint32_t weight = repeated(i, bits, 6);
        table[i] = static_cast<uint8_t>(weight > 32 ? weight + 1 : weight);
    }
    return table;
}

constexpr std::array<std::array<uint8_t, 32>, 6> weight_tables = {
    {{}, weight_table(1), weight_table(2), weight_table(3), weight_table(4), weight_table(5)}};

enum class Channels { luminance_alpha, rgb, rgba };
enum class Planes { one, two, two_alpha_apart };  ///< two: a field names the separate channel

struct Mode {
    uint32_t code;
    int code_bits;
    int hint_bits;  ///< for transcoders to other formats
    Channels channels;
    UastcPatternList patterns;
    int pattern_bits;
    size_t subsets;
    Planes planes;
    Range endpoints;
    int weight_bits;
};

constexpr auto one = UastcPatternList::one;
constexpr auto two = UastcPatternList::two;
constexpr auto two_7 = UastcPatternList::two_of_mode_7;
constexpr auto three = UastcPatternList::three;
constexpr auto la = Channels::luminance_alpha;
constexpr auto rgb = Channels::rgb;
constexpr auto rgba = Channels::rgba;

constexpr size_t solid_mode = 8;  // one colour of four bytes
constexpr Mode modes[] = {
    {0b0001, 4, 15, rgb, one, 0, 1, Planes::one, Range::to_191, 4},
    {0b110101, 6, 15, rgb, one, 0, 1, Planes::one, Range::to_255, 2},
    {0b11101, 5, 15, rgb, two, 5, 2, Planes::one, Range::to_15, 3},
    {0b00011, 5, 15, rgb, three, 4, 3, Planes::one, Range::to_11, 2},
    {0b10011, 5, 15, rgb, two, 5, 2, Planes::one, Range::to_39, 2},
    {0b01011, 5, 15, rgb, one, 0, 1, Planes::one, Range::to_255, 3},
    {0b11011, 5, 15, rgb, one, 0, 1, Planes::two, Range::to_159, 2},
    {0b00111, 5, 15, rgb, two_7, 5, 2, Planes::one, Range::to_39, 2},
    {0b10111, 5, 0, rgba, one, 0, 1, Planes::one, Range::to_255, 0},
    {0b01111, 5, 23, rgba, two, 5, 2, Planes::one, Range::to_15, 2},
    {0b010, 3, 17, rgba, one, 0, 1, Planes::one, Range::to_47, 4},
    {0b00, 2, 17, rgba, one, 0, 1, Planes::two, Range::to_47, 2},
    {0b110, 3, 17, rgba, one, 0, 1, Planes::one, Range::to_191, 3},
    {0b11111, 5, 23, rgba, one, 0, 1, Planes::two, Range::to_255, 1},
    {0b01101, 5, 23, rgba, one, 0, 1, Planes::one, Range::to_255, 2},
    {0b0000101, 7, 23, la, one, 0, 1, Planes::one, Range::to_255, 4},
    {0b010101, 6, 23, la, two, 5, 2, Planes::one, Range::to_255, 2},
    {0b100101, 6, 23, la, one, 0, 1, Planes::two_alpha_apart, Range::to_255, 2},
    {0b1001, 4, 15, rgb, one, 0, 1, Planes::one, Range::to_31, 5},
};

/// Reads the block's 128 bits, the lowest first.
class BlockBits {
public:
    explicit BlockBits(std::span<const std::byte, uastc_block_bytes> bytes) {
        for (size_t i = 0; i < 8; ++i) {
            low_ |= std::to_integer<uint64_t>(bytes[i]) << 8 * i;
            high_ |= std::to_integer<uint64_t>(bytes[8 + i]) << 8 * i;
        }
    }

    uint32_t peek(int count) const {
        return static_cast<uint32_t>(low_ & ((uint64_t{1} << count) - 1));
    }

    uint32_t take(int count) {
        if (count == 0) return 0;
        const uint32_t bits = peek(count);
        low_ = low_ >> count | high_ << (64 - count);
        high_ >>= count;
        return bits;
    }

private:
    uint64_t low_ = 0;
    uint64_t high_ = 0;
};

struct Endpoints {
    std::array<uint32_t, 4> low;  ///< R, G, B, A
    std::array<uint32_t, 4> high;
};

using Subsets = std::array<Endpoints, max_uastc_subsets>;

void read_values(BlockBits& bits, Range range, std::span<uint32_t> values) {
    const RangeForm form = form_of(range);
    if (form.base > 1) {
        const auto group = static_cast<size_t>(form.group);
        for (size_t first = 0; first < values.size(); first += group) {
            const size_t end = std::min(first + group, values.size());
            uint32_t packed = bits.take(form.group_bits[end - first]);
            for (size_t i = first; i < end; ++i) {
                values[i] = packed % form.base;
                packed /= form.base;
            }
        }
    }
    const ByteTable& table = unquantize_tables[static_cast<size_t>(range)];
    for (uint32_t& value : values)
        value = table[value << form.bits | bits.take(form.bits)];
}

void read_endpoints(BlockBits& bits, const Mode& mode, Subsets& subsets) {
    const size_t channels = mode.channels == la ? 2 : mode.channels == rgb ? 3 : 4;
    std::array<uint32_t, max_endpoint_values> values = {};
    read_values(bits, mode.endpoints, std::span(values).first(2 * channels * mode.subsets));
    const uint32_t* next = values.data();
    for (size_t s = 0; s < mode.subsets; ++s, next += 2 * channels) {
        for (size_t c = 0; c < 4; ++c) {
            const size_t from = mode.channels != la ? c : c == alpha_channel ? 1 : 0;
            const bool stored = from < channels;
            subsets[s].low[c] = stored ? next[2 * from] : 0xFF;
            subsets[s].high[c] = stored ? next[2 * from + 1] : 0xFF;
        }
    }
}

/// Source  Khronos Data Format 1.4, ASTC, "Weight Application"
uint32_t interpolated(uint32_t low, uint32_t high, uint32_t weight, bool srgb) {
    const uint32_t from = low << 8 | (srgb ? 0x80 : low);
    const uint32_t to = high << 8 | (srgb ? 0x80 : high);
    return (from * (64 - weight) + to * weight + 32) >> 14;  // by 64, then the upper byte
}

/// weights: of each channel.
uint32_t texel_of(const Endpoints& ends, const std::array<uint32_t, 4>& weights, bool srgb) {
    uint32_t texel = 0;
    for (uint32_t c = 0; c < 4; ++c) {
        texel |= interpolated(ends.low[c], ends.high[c], weights[c], srgb && c != alpha_channel)
                 << 8 * c;
    }
    return texel;
}

}  // namespace

bool decode_uastc_block(std::span<const std::byte, uastc_block_bytes> bytes,
                        bool srgb,
                        TexelBlock& texels) {
    BlockBits bits(bytes);
    const auto* mode = std::find_if(std::begin(modes), std::end(modes), [&](const Mode& row) {
        return bits.peek(row.code_bits) == row.code;
    });
    if (mode == std::end(modes)) return false;
    bits.take(mode->code_bits);
    if (mode == modes + solid_mode) {
        texels.fill(bits.take(32));
        return true;
    }
    bits.take(mode->hint_bits);
    const UastcPattern* pattern = uastc_pattern(mode->patterns, bits.take(mode->pattern_bits));
    if (pattern == nullptr) return false;
    const bool dual = mode->planes != Planes::one;
    const uint32_t apart = mode->planes == Planes::two ? bits.take(2) : alpha_channel;
    Subsets subsets = {};
    read_endpoints(bits, *mode, subsets);
    const std::array<uint8_t, 32>& table = weight_tables[static_cast<size_t>(mode->weight_bits)];
    for (size_t i = 0; i < texels.size(); ++i) {
        const size_t subset = pattern->subset[i];
        // The first weight of a subset is in the lower half: its upper bit is not stored.
        const int stored = mode->weight_bits - (pattern->anchor[subset] == i ? 1 : 0);
        std::array<uint32_t, 4> weights;
        weights.fill(table[bits.take(stored)]);
        if (dual) weights[apart] = table[bits.take(stored)];
        texels[i] = texel_of(subsets[subset], weights, srgb);
    }
    return true;
}

}  // namespace obscura
