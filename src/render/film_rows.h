// render/film_rows.h - interleaves sample columns into the pixels of a film.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/path_state.h"

#include <cstddef>
#include <cstdint>

namespace obscura {

/// Index in the film, which may be a crop, of a pixel of the whole image.
inline size_t pixel_index(const Film& film, int32_t x, int32_t y) {
    const int32_t x_0 = film.part_of ? film.part_of->x : 0;
    const int32_t y_0 = film.part_of ? film.part_of->y : 0;
    return static_cast<size_t>(y - y_0) * static_cast<size_t>(film.width) +
           static_cast<size_t>(x - x_0);
}

/// The pixel that each sample is written to.
struct FilmPixels {
    const int32_t* x;
    const int32_t* y;
    int count;
};

/// Writes sample i to pixel i, with as many channels as the film has. Large films bypass the caches
/// because they are not read soon.
void write_film(const SampleColumns& samples, const FilmPixels& pixels, Film& film);

}  // namespace obscura
