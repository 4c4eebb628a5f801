// image/bit_reader.h - reads bits from bytes, least significant bit first.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace obscura {

/// Never reads past the end: missing bits are 0, and overran() becomes true.
class BitReader {
public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// The next `count` bits (0 to 32), the first one lowest, without consuming them.
    uint32_t peek(int count) {
        while (held_ < count) {
            const uint64_t byte =
                next_ < bytes_.size() ? std::to_integer<uint64_t>(bytes_[next_++]) : 0;
            window_ |= byte << held_;
            held_ += 8;
        }
        return static_cast<uint32_t>(window_ & ((uint64_t{1} << count) - 1));
    }

    /// Consumes bits that peek has returned.
    void skip(int count) {
        window_ >>= count;
        held_ -= count;
        taken_ += static_cast<uint64_t>(count);
    }

    uint32_t read(int count) {
        const uint32_t bits = peek(count);
        skip(count);
        return bits;
    }

    /// True when more bits were consumed than there are.
    bool overran() const { return taken_ > 8 * uint64_t{bytes_.size()}; }

private:
    std::span<const std::byte> bytes_;
    size_t next_ = 0;
    uint64_t window_ = 0;
    int held_ = 0;  ///< bits in the window, at most 39
    uint64_t taken_ = 0;
};

}  // namespace obscura
