// image/write.h - writes finished images: EXR scene-linear, PNG and JPEG through a display.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/display.h"
#include "image/exr_options.h"
#include "image/image_metadata.h"
#include "image/layers.h"

#include <filesystem>
#include <string>

namespace obscura {

/// The image that a part belongs to, zero elsewhere; without layers.
OutputImage whole_image(const OutputImage& image);

/// The file of a layer of its own, beside the beauty's: shot.exr has shot.albedo.exr. A frame
/// number stays last: shot.0001.exr has shot.albedo.0001.exr.
std::filesystem::path layer_file(const std::filesystem::path& beauty, const std::string& layer);

/// Writes `file` by its extension: .exr, .png, .jpg/.jpeg. Atomically: an existing file is replaced
/// completely or not at all.
///
/// EXR: as `exr` says; half values are clamped to +-65504 and counted, and NaN becomes 0, float32
/// values are kept. A part of an image has its own data window inside the image's display window;
/// the other formats have none, and hold the whole image. They have no layers either. Layers in
/// files of their own are written before the beauty: where that is, all are.
/// PNG, JPEG: 8 bits; colour goes through `display`, data (or no display) is taken as values
/// in [0, 1]. A PNG keeps straight alpha; a JPEG (quality 95) lies over black.
///
/// Errors  73 E-OUT-CREATE the folder is missing or not writable; 74 E-OUT-WRITE disk full or I/O;
///         64 E-OUT-FORMAT another extension, or channels that a PNG or JPEG cannot hold;
///         64 E-OUT-LAYER layers that no EXR can hold side by side;
///         33 E-OUT-MEMORY; 70 E-OUT-ENCODE an inconsistent image
Result<WriteReport> write_image_file(const std::filesystem::path& file,
                                     const OutputImage& image,
                                     const ImageMetadata& metadata,
                                     const ExrOptions& exr,
                                     const DisplayTransform* display);

/// Checks before any work that `file` can be created: known extension, folder there and writable
/// (by creating and removing a temporary file), not a folder or device itself. Same errors.
Result<void> check_output(const std::filesystem::path& file);

}  // namespace obscura
