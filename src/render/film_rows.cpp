// render/film_rows.cpp - interleaves sample columns into the pixels of a film.
// SPDX-License-Identifier: Apache-2.0
#include "render/film_rows.h"

#include "base/stream_store.h"

#include <cstddef>

namespace obscura {

namespace {

/// Films with more floats than this do not stay in a cache until they are read.
constexpr size_t large_film = size_t{4} << 20U;

/// Four pixels side by side: a row of a tile's block.
template <int channels>
void write_four(const float* const (&columns)[4], int row, float* out) {
    for (int i = row; i < row + 4; ++i) {
        for (int c = 0; c < channels; ++c)
            *out++ = columns[c][i];
    }
}

template <int channels>
void write_pixels(const SampleColumns& samples, const FilmPixels& pixels, Film& film) {
    const float* const columns[] = {samples.r, samples.g, samples.b, samples.a};
    const bool large = film.pixels.size() > large_film;
    float* const start = film.pixels.data();
    for (int i = 0; i < pixels.count;) {
        float* out = start + channels * pixel_index(film, pixels.x[i], pixels.y[i]);
        const bool four = i + 4 <= pixels.count && pixels.y[i + 3] == pixels.y[i] &&
                          pixels.x[i + 3] == pixels.x[i] + 3;
        if (!four) {
            for (int c = 0; c < channels; ++c)
                out[c] = columns[c][i];
            ++i;
            continue;
        }
        if (channels == 3 && large && can_stream(out)) {
            stream_triples(samples.r + i, samples.g + i, samples.b + i, out);
        } else {
            write_four<channels>(columns, i, out);
        }
        i += 4;
    }
    if (large) end_streams();
}

}  // namespace

void write_film(const SampleColumns& samples, const FilmPixels& pixels, Film& film) {
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
