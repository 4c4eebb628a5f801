// image/image_header.h - reads the header of an encoded image without decoding it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/pixels.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace obscura {

enum class ImageFormat { png, jpeg, webp, ktx2 };

struct ImageHeader {
    ImageFormat format = ImageFormat::png;
    int width = 0;
    int height = 0;
    bool animated = false;
    int levels = 1;  ///< mip levels that it stores
    ImageEncoding encoding = ImageEncoding::unsaid;
    int bits = 8;  ///< per channel: 16, or 8 for 8 and fewer
};

/// "png", "jpeg", "webp" or "ktx2".
const char* format_name(ImageFormat format);

/// Tells PNG, JPEG, WebP and KTX2 apart by their first bytes and reads the size. Uses no library
/// and allocates nothing, so that headers with excessive sizes do no harm.
///
/// Errors  67 E-IMG-FORMAT none of the four (says what it looks like), 67 E-IMG-CORRUPT the
///         header is cut off or broken, 69 E-IMG-FEATURE a JPEG process that is not read
///         (12 bits, lossless, hierarchical) or a kind of KTX2 file that is not, 77 E-IMG-LIMIT a
///         side over 65536, over 2^29 pixels, or a JPEG of more than 1000 scans
Result<ImageHeader> read_image_header(std::span<const std::byte> bytes, const std::string& where);

/// Refuses images that are too large to decode, before anything is allocated.
///
/// In      family: first part of the error's name, such as "E-IMG"
/// Errors  77 "<family>-LIMIT" a side over 65536 or more than 2 GiB when decoded,
///         67 "<family>-CORRUPT" no pixel at all
Result<void> check_image_size(int64_t width,
                              int64_t height,
                              int bytes_per_pixel,
                              const std::string& family,
                              const std::string& where);

}  // namespace obscura
