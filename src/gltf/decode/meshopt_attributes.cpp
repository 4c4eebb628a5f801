// gltf/decode/meshopt_attributes.cpp - version 1 of KHR_meshopt_compression's attribute codec.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/meshopt_attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

namespace obscura::gltf {

namespace {

constexpr size_t group_size = 16;
constexpr size_t largest_block = 256;
constexpr size_t shortest_tail = 24;

/// Reads bytes from the front, with bounds checks.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    /// The next `count` bytes; nullptr: there are fewer.
    const uint8_t* take(size_t count) {
        if (rest_.size() < count) return nullptr;
        const auto* out = reinterpret_cast<const uint8_t*>(rest_.data());
        rest_ = rest_.subspan(count);
        return out;
    }
    bool is_empty() const { return rest_.empty(); }

private:
    std::span<const std::byte> rest_;
};

/// Reads 16 deltas of `bits` bits; one with all bits set stands for a whole byte behind them.
bool read_group(ByteReader& reader, unsigned bits, uint8_t* deltas) {
    if (bits == 0) {
        std::fill_n(deltas, group_size, uint8_t{0});
        return true;
    }
    const uint8_t* packed = reader.take(group_size * bits / 8);
    if (packed == nullptr) return false;
    if (bits == 8) {
        std::copy_n(packed, group_size, deltas);
        return true;
    }
    const unsigned all_ones = (1U << bits) - 1;
    const size_t per_byte = 8 / bits;
    for (size_t i = 0; i < group_size; ++i) {
        const auto slot = static_cast<unsigned>(i % per_byte);
        const unsigned shift = bits == 1 ? slot : 8 - bits * (slot + 1);
        const unsigned value = static_cast<unsigned>(packed[i / per_byte]) >> shift & all_ones;
        deltas[i] = static_cast<uint8_t>(value);
        if (value != all_ones) continue;
        const uint8_t* whole = reader.take(1);
        if (whole == nullptr) return false;
        deltas[i] = *whole;
    }
    return true;
}

/// Reads one two-bit field of a packed array.
unsigned two_bits(const uint8_t* packed, size_t index) {
    return static_cast<unsigned>(packed[index / 4]) >> (index % 4 * 2) & 3U;
}

/// Reads a block's deltas of one byte of the elements.
bool read_deltas(ByteReader& reader, unsigned control, size_t elements, uint8_t* deltas) {
    constexpr unsigned widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    if (control == 2) {
        std::fill_n(deltas, elements, uint8_t{0});
        return true;
    }
    if (control == 3) {
        const uint8_t* literal = reader.take(elements);
        if (literal != nullptr) std::copy_n(literal, elements, deltas);
        return literal != nullptr;
    }
    const size_t groups = (elements + group_size - 1) / group_size;
    const uint8_t* header = reader.take((groups + 3) / 4);
    if (header == nullptr) return false;
    for (size_t g = 0; g < groups; ++g) {
        const unsigned bits = widths[control][two_bits(header, g)];
        if (!read_group(reader, bits, deltas + g * group_size)) return false;
    }
    return true;
}

/// 0, -1, 1, -2 ... in T's arithmetic.
template <typename T>
T from_zigzag(T value) {
    return static_cast<T>((value & 1) != 0 ? ~(value >> 1) : value >> 1);
}

/// Adds a delta to each T of a channel's four bytes.
template <typename T>
uint32_t add_deltas(uint32_t previous, uint32_t delta) {
    uint32_t out = 0;
    constexpr unsigned width = 8 * sizeof(T);
    for (unsigned shift = 0; shift < 32; shift += width) {
        const T sum = static_cast<T>(static_cast<T>(previous >> shift) +
                                     from_zigzag(static_cast<T>(delta >> shift)));
        out |= static_cast<uint32_t>(sum) << shift;
    }
    return out;
}

/// One channel is four bytes of an element; its mode says what its deltas are.
uint32_t next_value(uint8_t mode, uint32_t previous, uint32_t delta) {
    if (mode == 0) return add_deltas<uint8_t>(previous, delta);
    if (mode == 1) return add_deltas<uint16_t>(previous, delta);
    return previous ^ std::rotr(delta, mode >> 4);
}

bool mode_is_known(uint8_t mode) {
    return mode == 0 || mode == 1 || (mode & 15) == 2;
}

/// The tail of a stream: the element before the first one, and each channel's mode.
struct Tail {
    const uint8_t* element;
    const uint8_t* modes;
};

/// Decodes block after block.
struct BlockDecoder {
    ByteReader reader;
    Tail tail;
    size_t stride;
    std::vector<uint8_t> deltas;     ///< largest_block for each byte of an element
    std::vector<uint32_t> previous;  ///< a channel each

    bool decode(size_t elements, std::byte* out) {
        const uint8_t* control = reader.take(stride / 4);
        if (control == nullptr) return false;
        for (size_t k = 0; k < stride; ++k) {
            uint8_t* row = deltas.data() + k * largest_block;
            if (!read_deltas(reader, two_bits(control, k), elements, row)) return false;
        }
        for (size_t element = 0; element < elements; ++element) {
            for (size_t channel = 0; channel < stride / 4; ++channel, out += 4)
                write_channel(element, channel, out);
        }
        return true;
    }

    void write_channel(size_t element, size_t channel, std::byte* out) {
        uint32_t delta = 0;
        for (unsigned b = 0; b < 4; ++b) {
            const uint32_t byte = deltas[(4 * channel + b) * largest_block + element];
            delta |= byte << (8 * b);
        }
        uint32_t& value = previous[channel];
        value = next_value(tail.modes[channel], value, delta);
        for (unsigned b = 0; b < 4; ++b)
            out[b] = static_cast<std::byte>(value >> (8 * b) & 255U);
    }
};

}  // namespace

bool decode_attributes_v1(std::span<const std::byte> from,
                          const ElementLayout& layout,
                          Bytes& out) {
    const size_t stride = layout.stride;
    const size_t tail_size = stride + stride / 4;
    const size_t padded = std::max(tail_size, shortest_tail);
    if (from.size() < 1 + padded) return false;
    const auto* tail = reinterpret_cast<const uint8_t*>(from.last(tail_size).data());
    BlockDecoder decoder{ByteReader(from.subspan(1, from.size() - 1 - padded)),
                         {tail, tail + stride},
                         stride,
                         std::vector<uint8_t>(stride * largest_block),
                         std::vector<uint32_t>(stride / 4)};
    if (!std::all_of(tail + stride, tail + tail_size, mode_is_known)) return false;
    for (size_t i = 0; i < stride; ++i)
        decoder.previous[i / 4] |= static_cast<uint32_t>(tail[i]) << (8 * (i % 4));

    const size_t most = std::min((8192 / stride) & ~(group_size - 1), largest_block);
    for (size_t done = 0; done < layout.count;) {
        const size_t elements = std::min<size_t>(most, layout.count - done);
        if (!decoder.decode(elements, out.data() + done * stride)) return false;
        done += elements;
    }
    return decoder.reader.is_empty();
}

}  // namespace obscura::gltf
