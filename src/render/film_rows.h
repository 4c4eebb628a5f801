// render/film_rows.h - samples, one column a channel, into the film's rows of pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/doors.h"

#include <cstdint>

namespace obscura {

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
