// render/film_rows.h - samples, one column a channel, into the film's rows of pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/doors.h"

#include <cstddef>
#include <cstdint>

namespace obscura {

/// Where a pixel of the whole image lies in a film that may be a part of it.
inline size_t pixel_index(const Film& film, int32_t x, int32_t y) {
    const int32_t x_0 = film.part_of ? film.part_of->x : 0;
    const int32_t y_0 = film.part_of ? film.part_of->y : 0;
    return static_cast<size_t>(y - y_0) * static_cast<size_t>(film.width) +
           static_cast<size_t>(x - x_0);
}

/// Where each sample row goes.
struct FilmPixels {
    const int32_t* x;
    const int32_t* y;
    int count;
};

/// Writes sample row i to pixel i, as many channels as the film has. Large films go past the
/// caches, for nobody reads them soon.
void write_film(const SampleRows& samples, const FilmPixels& pixels, Film& film);

}  // namespace obscura
