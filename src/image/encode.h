// image/encode.h - encodes finished images in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/write.h"

#include <cstddef>
#include <string>
#include <vector>

namespace obscura {

/// A file in memory, and what it could not keep.
struct EncodedFile {
    std::vector<std::byte> bytes;
    WriteReport report = {};
};

/// Encodes an image as an OpenEXR file: with its layers, unless they have files of their own. The
/// same image gives the same bytes on any number of threads. OpenEXR's exceptions pass through.
EncodedFile encode_exr(const OutputImage& image,
                       const ImageMetadata& metadata,
                       const ExrOptions& options,
                       const std::string& name);

/// Encodes one of the image's layers as a file of its own. As encode_exr.
EncodedFile encode_exr_layer(const OutputImage& image,
                             const ImageLayer& layer,
                             const ImageMetadata& metadata,
                             const ExrOptions& options,
                             const std::string& name);

enum class DisplayFormat { png, jpeg };

/// Encodes an image of 1 to 4 channels as PNG or JPEG; see write_image_file.
///
/// Errors  70 E-OUT-ENCODE with the library's message
Result<std::vector<std::byte>> encode_for_display(const OutputImage& image,
                                                  const ImageMetadata& metadata,
                                                  DisplayFormat format,
                                                  const DisplayTransform* display,
                                                  const std::string& where);

/// The image's interleaved 8-bit code values, as encode_for_display stores them: grey, RGB or RGBA
/// (JPEG: never alpha).
std::vector<unsigned char> display_codes(const OutputImage& image,
                                         bool keep_alpha,
                                         const DisplayTransform* display);

}  // namespace obscura
