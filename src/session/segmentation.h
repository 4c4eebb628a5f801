// session/segmentation.h - masks for data sets: the node of every pixel, and a list of the nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/film.h"
#include "image/image_metadata.h"
#include "image/layers.h"
#include "scene/scene.h"

#include <array>
#include <filesystem>
#include <string>

namespace obscura {

/// The files of `--segmentation`.
struct Segmentation {
    OutputImage ids;       ///< of the whole image: one channel, id / 65535 as codes of 16 bits are
    std::string document;  ///< JSON: image size and, for each id that is visible, what it is
};

/// Makes the files of a film whose last layer is segmentation_layer(). An id is the index of the
/// glTF node plus 1, so that it is the same in every image of an asset, and 0 is nothing.
///
/// In      film: of a scene that check_segmentation accepts
Segmentation segmentation_of(const Film& film, const Scene& scene);

/// Errors  69 E-SEG-IDS the scene has more nodes than ids of 16 bits
Result<void> check_segmentation(const Scene& scene);

/// The PNG, and the JSON beside it.
std::array<std::filesystem::path, 2> segmentation_files(const std::filesystem::path& png);

/// Writes both files, each whole or not at all; the PNG last.
///
/// In      metadata: of the beauty
/// Errors  those of write_image_file
Result<void> write_segmentation(const std::filesystem::path& png,
                                const Segmentation& segmentation,
                                const ImageMetadata& metadata);

}  // namespace obscura
