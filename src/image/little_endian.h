// image/little_endian.h - little-endian numbers, and bounds-checked ranges, in bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace obscura {

/// Four bytes at `at`, the lowest first; the caller has checked that they exist.
inline uint32_t little_endian_32(std::span<const std::byte> bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;)
        value = value << 8 | std::to_integer<uint32_t>(bytes[at + i]);
    return value;
}

/// Eight bytes, likewise.
inline uint64_t little_endian_64(std::span<const std::byte> bytes, size_t at) {
    return little_endian_32(bytes, at) | uint64_t{little_endian_32(bytes, at + 4)} << 32;
}

/// `length` bytes from `offset` on, of any size; nullopt: they are not all there.
inline std::optional<std::span<const std::byte>> range_of(std::span<const std::byte> bytes,
                                                          uint64_t offset,
                                                          uint64_t length) {
    if (offset > bytes.size() || length > bytes.size() - offset) return std::nullopt;
    return bytes.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
}

}  // namespace obscura
