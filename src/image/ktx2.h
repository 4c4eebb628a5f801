// image/ktx2.h - decodes KTX 2.0 files to straight-alpha RGBA8 with their mip levels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "image/ktx2_header.h"
#include "image/pixels.h"
#include "image/texel_block.h"

#include <string>
#include <vector>

namespace obscura {

/// Decodes the first `header.levels` levels. Warns of premultiplied alpha and of primaries that
/// are not sRGB's; neither is converted.
///
/// In      header: from read_ktx2_header; its bytes must still be there
/// Errors  67 E-IMG-CORRUPT broken data, 69 E-IMG-FEATURE frames of a video;
///         std::bad_alloc passes through
Result<ImageRgba8> decode_ktx2(const Ktx2Header& header, const std::string& where, Log& log);

/// Decodes BasisLZ's levels into memory that is opaque black.
///
/// Errors  as decode_ktx2
Result<void> decode_basis_lz(const Ktx2Header& header,
                             const std::vector<TexelLevel>& levels,
                             const std::string& where);

}  // namespace obscura
