// image/decode.h - decodes images in memory, and environment maps from files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "image/pixels.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace obscura {

/// How much of an image to decode: 8 bits of its base level, or its stored bits and mip levels.
enum class Extent { base, stored };

/// Decodes PNG, JPEG, WebP or KTX2 (told apart by their first bytes, not by name) to straight-alpha
/// RGBA8.
///
/// In      where: file with JSON pointer, for messages; extent: only KTX2 stores more than one
///         level, only PNG 16 bits
/// Out     grey, palette and CMYK images are converted; of an animation only the first frame, with
///         a warning. Thread-safe: different images may be decoded at the same time
/// Errors  67 E-IMG-CORRUPT truncated or broken, 67 E-IMG-FORMAT not one of the four,
///         69 E-IMG-FEATURE a 12-bit, lossless or hierarchical JPEG, a KTX2 file that is not a
///         still 2D image in a coding that glTF allows,
///         77 E-IMG-LIMIT a side over 65536 or over 2^29 pixels (checked before allocating),
///         33 E-IMG-MEMORY
Result<ImageRgba8> decode_image(std::span<const std::byte> bytes,
                                const std::string& where,
                                Log& log,
                                Extent extent = Extent::base);

/// Reads width, height, format, number of stored levels, encoding and bits from the header; texels
/// stays empty. Loads no library.
///
/// Errors  as decode_image, as far as the header shows them
Result<ImageRgba8> probe_image(std::span<const std::byte> bytes, const std::string& where);

/// Reads a latitude-longitude environment (Radiance .hdr, OpenEXR; also 8-bit images, decoded
/// from sRGB), told apart by their first bytes. Negative and NaN values become 0 and infinite ones
/// 65504, the largest half; they are counted in one warning. Alpha is ignored. An EXR's colour is
/// R, G, B, those of its first layer, or Y.
///
/// Errors  67 E-ENV-MISSING cannot be opened, E-ENV-FORMAT none of these formats, E-ENV-CORRUPT
///         truncated or broken; 65 E-ENV-ASPECT when width is not 2 * height;
///         77 E-ENV-LIMIT a side over 65536 or over 2 GiB as floats; 33 E-ENV-MEMORY
Result<ImageRgb32f> read_environment(const std::filesystem::path& file, Log& log);

}  // namespace obscura
