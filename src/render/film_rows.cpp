// render/film_rows.cpp - samples, one column a channel, into the film's rows of pixels.
// SPDX-License-Identifier: Apache-2.0
#include "render/film_rows.h"

#include <cstddef>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace obscura {

namespace {

/// Films of more floats than this do not stay in a cache until they are read.
constexpr size_t large_film = size_t{4} << 20U;

/// Four pixels side by side: a row of a tile's block.
template <int channels>
void write_four(const float* const (&columns)[4], int row, float* out) {
    for (int i = row; i < row + 4; ++i) {
        for (int c = 0; c < channels; ++c)
            *out++ = columns[c][i];
    }
}

#if defined(__SSE__)
/// As write_four for three channels, past the caches: a store that has to read its line first
/// moves it twice.
///
/// In      out: aligned to 16 bytes
void stream_four(const float* const (&columns)[4], int row, float* out) {
    const __m128 r = _mm_loadu_ps(columns[0] + row);
    const __m128 g = _mm_loadu_ps(columns[1] + row);
    const __m128 b = _mm_loadu_ps(columns[2] + row);
    const __m128 rg_low = _mm_unpacklo_ps(r, g);                               // r0 g0 r1 g1
    const __m128 rg_high = _mm_unpackhi_ps(r, g);                              // r2 g2 r3 g3
    const __m128 b0_r1 = _mm_shuffle_ps(b, r, _MM_SHUFFLE(1, 1, 0, 0));        // b0 b0 r1 r1
    const __m128 g1_b1 = _mm_shuffle_ps(g, b, _MM_SHUFFLE(1, 1, 1, 1));        // g1 g1 b1 b1
    const __m128 b2_r3 = _mm_shuffle_ps(b, rg_high, _MM_SHUFFLE(2, 2, 2, 2));  // b2 b2 r3 r3
    const __m128 g3_b3 = _mm_shuffle_ps(rg_high, b, _MM_SHUFFLE(3, 3, 3, 3));  // g3 g3 b3 b3
    _mm_stream_ps(out, _mm_shuffle_ps(rg_low, b0_r1, _MM_SHUFFLE(2, 0, 1, 0)));
    _mm_stream_ps(out + 4, _mm_shuffle_ps(g1_b1, rg_high, _MM_SHUFFLE(1, 0, 2, 0)));
    _mm_stream_ps(out + 8, _mm_shuffle_ps(b2_r3, g3_b3, _MM_SHUFFLE(2, 0, 2, 0)));
}

bool may_stream(const float* out) {
    return reinterpret_cast<uintptr_t>(out) % 16 == 0;
}
#endif

template <int channels>
void write_pixels(const SampleRows& samples, const FilmPixels& pixels, Film& film) {
    const float* const columns[] = {samples.r, samples.g, samples.b, samples.a};
    const auto width = static_cast<size_t>(film.width);
    [[maybe_unused]] const bool large = film.pixels.size() > large_film;
    float* const start = film.pixels.data();
    for (int i = 0; i < pixels.count;) {
        const auto x = static_cast<size_t>(pixels.x[i]);
        float* out = start + channels * (static_cast<size_t>(pixels.y[i]) * width + x);
        const bool four = i + 4 <= pixels.count && pixels.y[i + 3] == pixels.y[i] &&
                          pixels.x[i + 3] == pixels.x[i] + 3;
        if (!four) {
            for (int c = 0; c < channels; ++c)
                out[c] = columns[c][i];
            ++i;
            continue;
        }
#if defined(__SSE__)
        if (channels == 3 && large && may_stream(out)) {
            stream_four(columns, i, out);
            i += 4;
            continue;
        }
#endif
        write_four<channels>(columns, i, out);
        i += 4;
    }
#if defined(__SSE__)
    if (large) _mm_sfence();  // streams are not ordered before what tells other threads
#endif
}

}  // namespace

void write_film(const SampleRows& samples, const FilmPixels& pixels, Film& film) {
    switch (film.channels.size()) {
        case 1:
            return write_pixels<1>(samples, pixels, film);
        case 2:
            return write_pixels<2>(samples, pixels, film);
        case 3:
            return write_pixels<3>(samples, pixels, film);
        default:
            return write_pixels<4>(samples, pixels, film);
    }
}

}  // namespace obscura
