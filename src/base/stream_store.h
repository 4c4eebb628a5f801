// base/stream_store.h - non-temporal stores, for large data that are not read soon.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace obscura {

/// True if stream_triples may write to this address.
inline bool can_stream(const float* out) {
    return reinterpret_cast<uintptr_t>(out) % 16 == 0;
}

/// Writes x[0], y[0], z[0], x[1] and so on to z[3], bypassing the caches: an ordinary store would
/// first read the cache line.
///
/// In   out: can_stream; call end_streams before other threads read it
inline void stream_triples(const float* x, const float* y, const float* z, float* out) {
#if defined(__SSE__)
    const __m128 a = _mm_loadu_ps(x);
    const __m128 b = _mm_loadu_ps(y);
    const __m128 c = _mm_loadu_ps(z);
    const __m128 ab_low = _mm_unpacklo_ps(a, b);                         // x0 y0 x1 y1
    const __m128 ab_high = _mm_unpackhi_ps(a, b);                        // x2 y2 x3 y3
    const __m128 c0_a1 = _mm_shuffle_ps(c, a, _MM_SHUFFLE(1, 1, 0, 0));  // z0 z0 x1 x1
    const __m128 b1_c1 = _mm_shuffle_ps(b, c, _MM_SHUFFLE(1, 1, 1, 1));  // y1 y1 z1 z1
    const __m128 c2_a3 = _mm_shuffle_ps(c, a, _MM_SHUFFLE(3, 3, 2, 2));  // z2 z2 x3 x3
    const __m128 b3_c3 = _mm_shuffle_ps(b, c, _MM_SHUFFLE(3, 3, 3, 3));  // y3 y3 z3 z3
    _mm_stream_ps(out, _mm_shuffle_ps(ab_low, c0_a1, _MM_SHUFFLE(2, 0, 1, 0)));
    _mm_stream_ps(out + 4, _mm_shuffle_ps(b1_c1, ab_high, _MM_SHUFFLE(1, 0, 2, 0)));
    _mm_stream_ps(out + 8, _mm_shuffle_ps(c2_a3, b3_c3, _MM_SHUFFLE(2, 0, 2, 0)));
#else
    for (int i = 0; i < 4; ++i) {
        out[3 * i] = x[i];
        out[3 * i + 1] = y[i];
        out[3 * i + 2] = z[i];
    }
#endif
}

/// Store fence: makes this thread's streamed data visible before its later stores.
inline void end_streams() {
#if defined(__SSE__)
    _mm_sfence();
#endif
}

}  // namespace obscura
