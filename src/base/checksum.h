// base/checksum.h - a 64-bit checksum of bytes, against accidents.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace obscura {

/// XXH64 with seed 0. It tells torn and flipped bytes, and different files apart; it is no
/// protection against somebody who makes bytes to fit.
///
/// Source  Collet, "xxHash fast digest algorithm", specification 0.1.1
uint64_t checksum(std::span<const std::byte> bytes);

/// A checksum in names and headers: 16 hexadecimal digits.
std::string checksum_text(uint64_t checksum);

/// The same, of bytes that come piece by piece.
class RunningChecksum {
public:
    RunningChecksum();
    void add(std::span<const std::byte> bytes);
    /// Of all bytes so far.
    uint64_t value() const;

private:
    static constexpr size_t stripe = 32;
    std::array<uint64_t, 4> lanes_;
    std::array<std::byte, stripe> rest_ = {};  ///< bytes that fill no stripe yet
    size_t rest_size_ = 0;
    uint64_t size_ = 0;
};

}  // namespace obscura
