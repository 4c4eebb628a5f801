// image/png_chunks.h - what an encoded PNG says about its colours.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/display.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace obscura {

/// A copy of a PNG that says what its colours mean: a chunk sRGB for that encoding, cICP for
/// another, neither for none. The chunk oFFs is left out: our images begin in their corner.
///
/// In      png: complete, as an encoder wrote it
/// Source  Portable Network Graphics, third edition, sections 5.3, 11.3.2.5 and 11.3.2.6
std::vector<std::byte> with_color_chunk(std::span<const std::byte> png,
                                        const std::optional<ColorCodePoints>& code_points);

}  // namespace obscura
