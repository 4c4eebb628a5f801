// image/encode.h - finished pictures become encoded bytes in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/write.h"

#include <cstddef>
#include <string>
#include <vector>

namespace obscura {

/// A picture as an OpenEXR file. The same picture gives the same bytes on any number of threads.
/// Throws what OpenEXR throws.
std::vector<std::byte> encode_exr(const Picture& picture,
                                  const PictureMetadata& metadata,
                                  ExrDepth depth,
                                  const std::string& name);

enum class DisplayFormat { png, jpeg };

/// A picture of 1 to 4 channels as PNG or JPEG; see write_picture.
///
/// Errors  70 E-OUT-ENCODE what the library says
Result<std::vector<std::byte>> encode_for_display(const Picture& picture,
                                                  const PictureMetadata& metadata,
                                                  DisplayFormat format,
                                                  const DisplayTransform* display,
                                                  const std::string& where);

/// The picture's 8-bit code values, interleaved, as encode_for_display stores them: grey, RGB or
/// RGBA (JPEG: never alpha).
std::vector<unsigned char> display_codes(const Picture& picture,
                                         bool keep_alpha,
                                         const DisplayTransform* display);

}  // namespace obscura
