// image/layers.h - a finished image: the beauty, and layers of the same size.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"
#include "image/layer_kind.h"
#include "image/pixels.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// Further channels of an image.
struct ImageLayer {
    std::string name;                   ///< unique; it becomes the name of a part or file
    std::vector<std::string> channels;  ///< full names, as in the file: "albedo.R", "Z"
    LayerKind kind = LayerKind::data;
    UnsetArray<float> pixels;     ///< as many as the beauty has, see image/channel_planes.h
    std::string expression = {};  ///< what it shows, for the header; may be empty
    /// How samples became a pixel, for the header: "mean" or empty; anything else is no mean.
    std::string reduction = {};
    /// Further text attributes, by their names in the file.
    std::vector<std::pair<std::string, std::string>> metadata = {};
    std::vector<std::string> names = {};  ///< of Cryptomatte: what its ids stand for
};

/// A finished image: float32, rows from the top, scene-linear (ImageMetadata::space). Channels of
/// the beauty are interleaved, those of layers in planes.
struct OutputImage {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  ///< "R","G","B","A" or e.g. "Z", "N.X","N.Y","N.Z"
    /// alpha premultiplied where there is an A
    UnsetArray<float> pixels;
    /// None: the pixels are all there is. With overscan the part begins before the whole image and
    /// ends behind it.
    std::optional<ImagePart> part_of = {};
    std::vector<ImageLayer> layers = {};  ///< of the same part; only EXR files have them
};

}  // namespace obscura
