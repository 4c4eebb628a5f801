// render/film_rows.h - interleaves sample columns into the pixels of a film.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/path_state.h"

#include <cstddef>
#include <cstdint>

namespace obscura {

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
