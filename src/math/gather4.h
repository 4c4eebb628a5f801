// math/gather4.h - gathers two or four neighbouring words per lane, cheaper than separate gathers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Words [i, i + 4) of a table, one member per word.
template <typename T>
struct Four {
    T x, y, z, w;
};

#if defined(__AVX512F__)
/// 16 loads of 16 bytes and a transposition: faster than gathers, which load single words.
OBSCURA_INLINE Four<Lanes> gather4_lanes(const float* base, LanesI first) {
    alignas(64) int32_t at[lane_count];
    _mm512_store_si512(at, first.v);
    const auto two = [&](int k) {
        return _mm256_insertf128_ps(
            _mm256_castps128_ps256(_mm_loadu_ps(base + at[k])), _mm_loadu_ps(base + at[k + 4]), 1);
    };
    const auto rows = [&](int k) {  // of lanes k, k + 4, k + 8, k + 12
        return _mm512_insertf32x8(_mm512_castps256_ps512(two(k)), two(k + 8), 1);
    };
    const __m512 a = rows(0);
    const __m512 b = rows(1);
    const __m512 c = rows(2);
    const __m512 d = rows(3);
    const __m512d xy01 = _mm512_castps_pd(_mm512_unpacklo_ps(a, b));
    const __m512d zw01 = _mm512_castps_pd(_mm512_unpackhi_ps(a, b));
    const __m512d xy23 = _mm512_castps_pd(_mm512_unpacklo_ps(c, d));
    const __m512d zw23 = _mm512_castps_pd(_mm512_unpackhi_ps(c, d));
    return {BatchF(_mm512_castpd_ps(_mm512_unpacklo_pd(xy01, xy23))),
            BatchF(_mm512_castpd_ps(_mm512_unpackhi_pd(xy01, xy23))),
            BatchF(_mm512_castpd_ps(_mm512_unpacklo_pd(zw01, zw23))),
            BatchF(_mm512_castpd_ps(_mm512_unpackhi_pd(zw01, zw23)))};
}
#elif defined(__AVX2__)
OBSCURA_INLINE Four<Lanes> gather4_lanes(const float* base, LanesI first) {
    alignas(32) int32_t at[lane_count];
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), first.v);
    const auto rows = [&](int k) {  // of lanes k and k + 4
        return _mm256_insertf128_ps(
            _mm256_castps128_ps256(_mm_loadu_ps(base + at[k])), _mm_loadu_ps(base + at[k + 4]), 1);
    };
    const __m256 a = rows(0);
    const __m256 b = rows(1);
    const __m256 c = rows(2);
    const __m256 d = rows(3);
    const __m256d xy01 = _mm256_castps_pd(_mm256_unpacklo_ps(a, b));
    const __m256d zw01 = _mm256_castps_pd(_mm256_unpackhi_ps(a, b));
    const __m256d xy23 = _mm256_castps_pd(_mm256_unpacklo_ps(c, d));
    const __m256d zw23 = _mm256_castps_pd(_mm256_unpackhi_ps(c, d));
    return {BatchF(_mm256_castpd_ps(_mm256_unpacklo_pd(xy01, xy23))),
            BatchF(_mm256_castpd_ps(_mm256_unpackhi_pd(xy01, xy23))),
            BatchF(_mm256_castpd_ps(_mm256_unpacklo_pd(zw01, zw23))),
            BatchF(_mm256_castpd_ps(_mm256_unpackhi_pd(zw01, zw23)))};
}
#elif defined(__x86_64__)
OBSCURA_INLINE Four<Lanes> gather4_lanes(const float* base, LanesI first) {
    alignas(16) int32_t at[lane_count];
    first.v.store_aligned(at);
    __m128 a = _mm_loadu_ps(base + at[0]);
    __m128 b = _mm_loadu_ps(base + at[1]);
    __m128 c = _mm_loadu_ps(base + at[2]);
    __m128 d = _mm_loadu_ps(base + at[3]);
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {BatchF(a), BatchF(b), BatchF(c), BatchF(d)};
}
#else
OBSCURA_INLINE Four<Lanes> gather4_lanes(const float* base, LanesI first) {
    return {BatchF::gather(base, first.v),
            BatchF::gather(base + 1, first.v),
            BatchF::gather(base + 2, first.v),
            BatchF::gather(base + 3, first.v)};
}
#endif

/// Reads base[i] to base[i + 3] for every lane. All four words must exist, even unused ones and in
/// idle lanes: tables read this way have padding at their end.
template <typename F>
OBSCURA_INLINE Four<F> gather4(const float* base, const IntOf<F>& i) {
    if constexpr (std::is_same_v<F, Lanes>) {
        return gather4_lanes(base, i);
    } else {
        return {F(base[i]), F(base[i + 1]), F(base[i + 2]), F(base[i + 3])};
    }
}

/// As above, for integers.
template <typename F>
OBSCURA_INLINE Four<IntOf<F>> gather4(const int32_t* base, const IntOf<F>& i) {
    if constexpr (std::is_same_v<F, Lanes>) {
        const Four<Lanes> words = gather4_lanes(reinterpret_cast<const float*>(base), i);
        return {float_bits(words.x), float_bits(words.y), float_bits(words.z), float_bits(words.w)};
    } else {
        return {base[i], base[i + 1], base[i + 2], base[i + 3]};
    }
}

/// Words [i, i + 2) of a table.
template <typename T>
struct Two {
    T x, y;
};

#if defined(__x86_64__)
/// Loads of 8 bytes: a vector of the words of lanes 0, 1, 4, 5, ..., one of 2, 3, 6, 7, ...
OBSCURA_INLINE Two<LanesI> gather2_lanes(const int32_t* base, LanesI first) {
    alignas(64) int32_t at[lane_count];
    first.v.store_aligned(at);
    const auto two = [&](int k) {  // lanes k and k + 1
        const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + at[k]));
        return _mm_loadh_pi(_mm_castsi128_ps(low),
                            reinterpret_cast<const __m64*>(base + at[k + 1]));
    };
    constexpr int first_words = _MM_SHUFFLE(2, 0, 2, 0);
    constexpr int second_words = _MM_SHUFFLE(3, 1, 3, 1);
#if defined(__AVX2__)
    const auto four = [&](int k) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(two(k)), two(k + 4), 1);
    };
#endif
#if defined(__AVX512F__)
    const auto eight = [&](int k) {
        return _mm512_insertf32x8(_mm512_castps256_ps512(four(k)), four(k + 8), 1);
    };
    const __m512 a = eight(0);
    const __m512 b = eight(2);
    return {BatchI(_mm512_castps_si512(_mm512_shuffle_ps(a, b, first_words))),
            BatchI(_mm512_castps_si512(_mm512_shuffle_ps(a, b, second_words)))};
#elif defined(__AVX2__)
    const __m256 a = four(0);
    const __m256 b = four(2);
    return {BatchI(_mm256_castps_si256(_mm256_shuffle_ps(a, b, first_words))),
            BatchI(_mm256_castps_si256(_mm256_shuffle_ps(a, b, second_words)))};
#else
    const __m128 a = two(0);
    const __m128 b = two(2);
    return {BatchI(_mm_castps_si128(_mm_shuffle_ps(a, b, first_words))),
            BatchI(_mm_castps_si128(_mm_shuffle_ps(a, b, second_words)))};
#endif
}
#else
OBSCURA_INLINE Two<LanesI> gather2_lanes(const int32_t* base, LanesI first) {
    return {BatchI::gather(base, first.v), BatchI::gather(base + 1, first.v)};
}
#endif

/// Reads base[i] and base[i + 1] for every lane. Both must exist, in idle lanes too.
template <typename F>
OBSCURA_INLINE Two<UintOf<F>> gather2(const uint32_t* base, const IntOf<F>& i) {
    if constexpr (std::is_same_v<F, Lanes>) {
        const Two<LanesI> words = gather2_lanes(reinterpret_cast<const int32_t*>(base), i);
        return {as_uint(words.x), as_uint(words.y)};
    } else {
        return {base[i], base[i + 1]};
    }
}

/// Prefetches the memory that gather4(base, i) will read.
template <typename F, typename T>
OBSCURA_INLINE void prefetch(const T* base, const IntOf<F>& i) {
    if constexpr (std::is_same_v<F, Lanes>) {
        alignas(64) int32_t at[lane_count];
        store(at, i);
        for (int lane = 0; lane < lane_count; ++lane)
            __builtin_prefetch(base + at[lane]);
    } else {
        __builtin_prefetch(base + i);
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
