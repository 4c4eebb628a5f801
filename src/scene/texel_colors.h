// scene/texel_colors.h - converts the colours of texels to another rendering space.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/rgb_primaries.h"

#include <cstddef>
#include <cstdint>

namespace obscura {

/// Converts 16-bit sRGB-encoded texels in place: decoded, taken through the matrix, and encoded by
/// the same curve. Alpha stays.
///
/// In      high, low: the high and low bytes, see TextureRecord; matrix: of a RenderingSpace, so
///         that colours stay in [0, 1]
/// Out     decoded as look-ups do it, colours are right to half a 16-bit code
void convert_texels(const Matrix3& matrix, uint32_t* high, uint32_t* low, size_t count);

}  // namespace obscura
