// film/murmur_hash.h - MurmurHash3 of byte strings, the hash that Cryptomatte names have.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace obscura {

/// The 32-bit hash of all bytes, the same on machines of either byte order. Of no bytes with seed 0
/// it is 0.
///
/// In      bytes: any, also zero; Cryptomatte hashes with seed 0
/// Source  Appleby, MurmurHash3_x86_32, in SMHasher (public domain)
uint32_t murmur_hash(std::string_view bytes, uint32_t seed = 0) noexcept;

}  // namespace obscura
