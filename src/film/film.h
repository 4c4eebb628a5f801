// film/film.h - a finished image in memory: the beauty and the layers beside it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"
#include "film/layers.h"
#include "image/pixels.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// A layer with its pixels: float32, as many as the film has, in planes (image/channel_planes.h).
struct FilmLayer {
    Layer layer;
    UnsetArray<float> pixels;
    std::vector<std::string> names = {};  ///< that ids of a Cryptomatte layer stand for
};

/// A finished film, float32, rows from the top: as large as the crop where there is one.
struct Film {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  ///< R G B A; or e.g. Z; N.X N.Y N.Z
    UnsetArray<float> pixels;
    std::optional<ImagePart> part_of = {};  ///< with a crop: of the whole image
    std::vector<FilmLayer> layers = {};
};

/// Index in the film, which may be a crop, of a pixel of the whole image.
inline size_t pixel_index(const Film& film, int32_t x, int32_t y) {
    const int32_t x_0 = film.part_of ? film.part_of->x : 0;
    const int32_t y_0 = film.part_of ? film.part_of->y : 0;
    return static_cast<size_t>(y - y_0) * static_cast<size_t>(film.width) +
           static_cast<size_t>(x - x_0);
}

}  // namespace obscura
