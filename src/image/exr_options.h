// image/exr_options.h - how an image is stored in OpenEXR files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

enum class ExrDepth { half, float32 };

/// Where layers lie: in one part with the beauty, each in a part of its own, or each in a file of
/// its own beside the beauty's.
enum class ExrLayout { single, multipart, separate };

/// OpenEXR's codecs; pxr24 and those after it are lossy.
enum class ExrCompression { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab };

struct ExrOptions {
    /// Of colour; data and ids are always 32-bit floats. dwaa and dwab keep halves.
    ExrDepth depth = ExrDepth::half;
    ExrLayout layout = ExrLayout::single;
    /// Of colour. Data and ids are never lossy: a part of data has ZIP in place of a lossy codec. A
    /// single part has one codec for all; where that rounds 32-bit floats (pxr24, dwaa, dwab) and
    /// there are data, the whole part has ZIP.
    ExrCompression compression = ExrCompression::zip;
    float dwa_level = 45;  ///< of dwaa and dwab, >= 0; greater: smaller and worse
    int tile_size = 0;     ///< in pixels; 0: scan lines
    /// With smaller copies down to one pixel, in tiles (of 64 pixels unless tile_size says else):
    /// means of 2x2 pixels, of ids and of layers whose reduction is no mean the upper left one.
    bool mipmap = false;
};

/// What a file could not keep.
struct WriteReport {
    uint64_t clamped_values = 0;    ///< beyond +-largest_half in a half channel
    float largest_half = 65504;     ///< less with DWA
    bool half_instead = false;      ///< of 32 bits; see ExrOptions
    bool lossless_instead = false;  ///< ZIP in place of the codec for colour; see ExrOptions
};

}  // namespace obscura
