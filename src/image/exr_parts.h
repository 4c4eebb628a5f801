// image/exr_parts.h - which channels of an image lie in which part of an OpenEXR file, and how.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/channel_planes.h"
#include "image/exr_options.h"
#include "image/image_metadata.h"
#include "image/layers.h"

#include <OpenEXR/ImfHeader.h>

#include <string>
#include <vector>

namespace obscura {

/// The channels of the beauty or of a layer.
struct ExrGroup {
    const std::vector<std::string>* channels;
    const UnsetArray<float>* pixels;
    LayerKind kind;
    const ImageLayer* layer;  ///< null: the beauty
};

/// Calls use(plane) for each plane of a group. The beauty's channels all lie side by side.
template <typename Use>
void for_planes(const ExrGroup& group, const Use& use) {
    const size_t channels = group.channels->size();
    if (group.layer == nullptr) return use(ChannelPlane{0, channels, 0});
    for_planes(channels, group.pixels->size() / channels, use);
}

/// The rows of an image that a part has: all, or those of one of its views.
struct ExrRows {
    int first, count;  ///< in memory
    int top, height;   ///< of the whole image, which may be larger than what is in memory
    std::string view;  ///< "left"; empty: the image is one view
};

/// One part of a file.
struct ExrPart {
    std::string name;
    std::vector<ExrGroup> groups;
    ExrCompression compression;
    ExrRows rows;
};

/// What all parts of a file are made from; it outlives them.
struct ExrContent {
    const OutputImage& image;
    const ImageMetadata& metadata;
    const ExrOptions& options;
};

/// The name of the beauty's part: compositing programs take one that is called rgba or main for
/// the image's own channels.
const char* beauty_part_name(const ImageMetadata& metadata);

/// The parts of an image's file, the beauty's first. A multipart file of several views has all
/// parts of the first view, then those of the next.
std::vector<ExrPart> parts_of_image(const ExrContent& content);

/// The only part of a layer's own file.
ExrPart part_of_layer(const ExrContent& content, const ImageLayer& layer);

/// Half or float, by the kind of the channels and the depth of colour. DWA keeps no more than
/// halves.
ExrDepth depth_of(const ExrGroup& group, const ExrPart& part, const ExrOptions& options);

/// True when smaller copies have means, false when they have the upper left one of 2x2 pixels.
bool is_averaged(const ExrGroup& group);

/// True when the codec for colour would have rounded data in the same part.
bool is_lossless_instead(const ExrPart& part, const ExrOptions& options);

/// True when colours are to be floats, and the codec keeps halves.
bool is_half_instead(const ExrPart& part, const ExrOptions& options);

/// Sets an attribute; an empty text is left out.
void insert_attribute(Imf::Header& header, const ImageAttribute& attribute);

/// The headers of a file's parts, with their names where there are several.
std::vector<Imf::Header> headers_of(const ExrContent& content, const std::vector<ExrPart>& parts);

/// 64 E-OUT-LAYER unless layers have names that parts and files can have, and channels of their
/// own.
Result<void> check_layers(const ExrContent& content, const std::string& where);

}  // namespace obscura
