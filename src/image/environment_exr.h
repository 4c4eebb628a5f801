// image/environment_exr.h - reads OpenEXR files in memory as linear RGB.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "image/pixels.h"

#include <cstddef>
#include <span>
#include <string>

namespace obscura {

/// Reads R, G, B (of the file itself, else of its first layer that has them) or Y of the first
/// part's data window. Values are not changed.
///
/// Errors  67 E-ENV-CORRUPT, 65 E-ENV-ASPECT, 77 E-ENV-LIMIT (before allocating)
Result<ImageRgb32f> read_exr(std::span<const std::byte> bytes, const std::string& where, Log& log);

/// 65 E-ENV-ASPECT unless width is 2 * height, 77 E-ENV-LIMIT when it is too large.
Result<void> check_environment_size(int64_t width, int64_t height, const std::string& where);

}  // namespace obscura
