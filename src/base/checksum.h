// base/checksum.h - a 64-bit checksum of bytes, against accidents.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace obscura {

/// XXH64 with seed 0. It tells torn and flipped bytes, and different files apart; it is no
/// protection against somebody who makes bytes to fit.
///
/// Source  Collet, "xxHash fast digest algorithm", specification 0.1.1
uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace obscura
