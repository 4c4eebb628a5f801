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
    ExrDepth depth = ExrDepth::half;  ///< of colour; data and ids are always 32-bit floats
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
    uint64_t clamped_values = 0;    ///< beyond +-65504 in a half channel
    bool lossless_instead = false;  ///< ZIP in place of the codec for colour; see ExrOptions
};

}  // namespace obscura
