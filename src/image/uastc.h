// image/uastc.h - decodes UASTC LDR 4x4 blocks to texels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/texel_block.h"

#include <cstddef>
#include <span>

namespace obscura {

inline constexpr size_t uastc_block_bytes = 16;

/// Decodes one block, exactly by ASTC's rules; ignores hints for other formats.
///
/// In      srgb: the texels are sRGB-encoded, which ASTC rounds differently (not so alpha)
/// Errors  false: a reserved mode or a pattern that does not exist
/// Source  Binomial, "UASTC LDR 4x4 Texture Specification"; Khronos Data Format 1.4, ASTC
bool decode_uastc_block(std::span<const std::byte, uastc_block_bytes> bytes,
                        bool srgb,
                        TexelBlock& texels);

}  // namespace obscura
