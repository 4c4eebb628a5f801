// image/uastc.h - UASTC LDR 4x4 blocks become texels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/texel_block.h"

#include <cstddef>
#include <span>

namespace obscura {

inline constexpr size_t uastc_block_bytes = 16;

/// Decodes one block, exactly as ASTC's rules say; hints for other formats are passed over.
///
/// In      srgb: the texels are sRGB-encoded, which ASTC rounds differently (not so alpha)
/// Errors  false: a reserved mode or a pattern that does not exist
/// Source  Binomial, "UASTC LDR 4x4 Texture Specification"; Khronos Data Format 1.4, ASTC
bool decode_uastc_block(std::span<const std::byte, uastc_block_bytes> bytes,
                        bool srgb,
                        TexelBlock& texels);

}  // namespace obscura
