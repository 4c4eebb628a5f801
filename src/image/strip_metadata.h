// image/strip_metadata.h - takes everything but the pixels out of encoded pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/image_header.h"

#include <cstddef>
#include <span>
#include <vector>

namespace obscura {

/// A copy of a PNG or JPEG without colour profiles, gamma, Exif, comments and stray bytes.
///
/// glTF takes texels as they are and ignores all of these, while the libraries stumble over damaged
/// ones and write warnings about common ones to standard error. A picture that is cut off or broken
/// keeps its fault for the decoder to find; WebP is copied as it is.
std::vector<std::byte> without_metadata(std::span<const std::byte> bytes, ImageFormat format);

}  // namespace obscura
