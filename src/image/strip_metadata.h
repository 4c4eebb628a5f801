// image/strip_metadata.h - removes metadata from encoded PNG and JPEG images.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/image_header.h"

#include <cstddef>
#include <span>
#include <vector>

namespace obscura {

/// A copy of a PNG or JPEG without colour profiles, gamma, Exif, comments and stray bytes.
///
/// glTF ignores all of these, while libraries fail on damaged ones and write warnings about common
/// ones to standard error. Truncated or broken images stay so for the decoder to detect; WebP is
/// copied unchanged.
std::vector<std::byte> without_metadata(std::span<const std::byte> bytes, ImageFormat format);

}  // namespace obscura
