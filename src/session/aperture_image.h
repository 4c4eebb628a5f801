// session/aperture_image.h - reads the image of a lens opening from a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "camera/aperture_table.h"

#include <filesystem>

namespace obscura {

/// Reads a PNG, JPEG, WebP or KTX2 image: the lens lets light through where it is bright (linear
/// luminance times alpha).
///
/// Errors  67 E-APERTURE-MISSING, E-APERTURE-BLACK, and those of decode_image
Result<ApertureTable> read_aperture(const std::filesystem::path& file, Log& log);

}  // namespace obscura
