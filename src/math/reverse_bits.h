// math/reverse_bits.h - reverses the bits of words, scalar or in lanes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

// clang-format off
/// Bit 31 becomes bit 0 and so on.
OBSCURA_INLINE uint32_t reverse_bits(uint32_t a) {
    a = ((a >> 1) & 0x55555555U) | ((a & 0x55555555U) << 1);
    a = ((a >> 2) & 0x33333333U) | ((a & 0x33333333U) << 2);
    a = ((a >> 4) & 0x0F0F0F0FU) | ((a & 0x0F0F0F0FU) << 4);
    return __builtin_bswap32(a);
}
#if defined(__AVX512BW__)
OBSCURA_INLINE LanesU reverse_bits(LanesU a) {  // two nibble tables, then the bytes of each word
    const __m512i mask = _mm512_set1_epi8(0x0F);
    const __m512i high_of = _mm512_broadcast_i32x4(
        _mm_setr_epi8(0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80, 112, -16));
    const __m512i low_of = _mm512_broadcast_i32x4(
        _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15));
    const __m512i swap = _mm512_broadcast_i32x4(
        _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12));
    const __m512i low = _mm512_shuffle_epi8(high_of, _mm512_and_si512(a.v, mask));
    const __m512i high =
        _mm512_shuffle_epi8(low_of, _mm512_and_si512(_mm512_srli_epi32(a.v, 4), mask));
    return BatchU(_mm512_shuffle_epi8(_mm512_or_si512(low, high), swap));
}
#elif defined(__AVX2__)
OBSCURA_INLINE LanesU reverse_bits(LanesU a) {
    const __m256i mask = _mm256_set1_epi8(0x0F);
    const __m256i high_of = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80, 112, -16));
    const __m256i low_of = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15));
    const __m256i swap = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12));
    const __m256i low = _mm256_shuffle_epi8(high_of, _mm256_and_si256(a.v, mask));
    const __m256i high =
        _mm256_shuffle_epi8(low_of, _mm256_and_si256(_mm256_srli_epi32(a.v, 4), mask));
    return BatchU(_mm256_shuffle_epi8(_mm256_or_si256(low, high), swap));
}
#else
OBSCURA_INLINE LanesU reverse_bits(LanesU a) {
    a = ((a >> 1) & LanesU(0x55555555U)) | ((a & LanesU(0x55555555U)) << 1);
    a = ((a >> 2) & LanesU(0x33333333U)) | ((a & LanesU(0x33333333U)) << 2);
    a = ((a >> 4) & LanesU(0x0F0F0F0FU)) | ((a & LanesU(0x0F0F0F0FU)) << 4);
    a = ((a >> 8) & LanesU(0x00FF00FFU)) | ((a & LanesU(0x00FF00FFU)) << 8);
    return (a >> 16) | (a << 16);
}
#endif
// clang-format on

}  // namespace OBSCURA_ISA
}  // namespace obscura
