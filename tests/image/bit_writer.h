// tests/image/bit_writer.h - puts bits into bytes, the lowest bit of the first byte first.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace obscura::testing_images {

class BitWriter {
public:
    void put(uint64_t value, int count) {
        for (int i = 0; i < count; ++i)
            put_bit((value >> i & 1U) != 0);
    }

    /// A prefix code as it is written on paper: its first character comes first.
    void put_code(std::string_view code) {
        for (const char bit : code)
            put_bit(bit == '1');
    }

    size_t bits() const { return bits_; }
    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    void put_bit(bool bit) {
        if (bits_ % 8 == 0) bytes_.push_back(std::byte{0});
        if (bit) bytes_.back() |= std::byte{1} << static_cast<int>(bits_ % 8);
        ++bits_;
    }

    std::vector<std::byte> bytes_;
    size_t bits_ = 0;
};

}  // namespace obscura::testing_images
