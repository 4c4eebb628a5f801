// image/ktx2_header.h - the header of a KTX 2.0 file, and the position of its levels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/pixels.h"
#include "surface/texture_record.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace obscura {

enum class Ktx2Coding { basis_lz, uastc, plain };

/// The channels of an image. Missing ones become 0, alpha opaque; `red` is repeated in green and
/// blue.
enum class Ktx2Channels {
    rgb,
    rgba,
    red,
    red_green,
    red_green_in_alpha,  ///< UASTC's RRRG: green is stored where alpha is
};

struct Ktx2Header {
    int width = 0;
    int height = 0;
    Ktx2Coding coding = Ktx2Coding::plain;
    Ktx2Channels channels = Ktx2Channels::rgba;
    int bytes_per_texel = 0;  ///< of plain texels
    bool is_zstd = false;     ///< levels are compressed once more
    bool is_premultiplied = false;
    bool has_other_primaries = false;  ///< neither unspecified nor those of sRGB
    ImageEncoding encoding = ImageEncoding::unsaid;
    int levels = 1;
    int levels_in_file = 1;  ///< `levels` may be lowered to read fewer
    std::array<std::span<const std::byte>, max_mip_levels> level_bytes;  ///< level 0 first
    std::span<const std::byte> global_bytes;                             ///< BasisLZ's

    int level_width(int level) const { return width >> level > 0 ? width >> level : 1; }
    int level_height(int level) const { return height >> level > 0 ? height >> level : 1; }

    /// Bytes of a level without BasisLZ and Zstandard.
    size_t plain_bytes(int level) const;
};

/// Whether the file begins as KTX 2.0 files do.
bool is_ktx2(std::span<const std::byte> bytes);

/// Reads and checks everything but the levels' contents; allocates nothing.
///
/// In      bytes: the whole file, which is_ktx2 knows; where: for messages
/// Errors  67 E-IMG-CORRUPT cut off or contradictory, 77 E-IMG-LIMIT too large,
///         69 E-IMG-FEATURE not a 2D image, or stored in a way that glTF does not allow: a
///         format, supercompression, orientation or swizzle that is not read
/// Source  Khronos, "KTX File Format Specification", version 2.0
Result<Ktx2Header> read_ktx2_header(std::span<const std::byte> bytes, const std::string& where);

}  // namespace obscura
