// image/pixels.h - decoded images in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

/// The encoding of colours that a file declares.
enum class ImageEncoding { unsaid, linear, srgb };

/// 8 or 16 bits a channel, rows from the top, alpha not premultiplied; R in the lowest byte of a
/// texel.
struct ImageRgba8 {
    int width = 0;
    int height = 0;
    std::vector<uint32_t> texels;
    std::string format;  ///< "png", "jpeg", "webp", "ktx2"
    int levels = 1;      ///< mip levels in `texels`, one behind the other, level 0 first
    ImageEncoding encoding = ImageEncoding::unsaid;
    int bits = 8;  ///< of a channel in the file
    /// The low bytes of 16-bit channels, if they were asked for; `texels` are then the high ones.
    std::vector<uint32_t> low_bytes = {};
};

/// Linear Rec.709 RGB, 3 floats a pixel, rows from the top.
struct ImageRgb32f {
    int width = 0;
    int height = 0;
    std::vector<float> pixels;
};

/// Position of a part in the whole image, from its top left corner.
struct ImagePart {
    int width = 0, height = 0;  ///< of the whole image
    int x = 0, y = 0;
};

}  // namespace obscura
