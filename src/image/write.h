// image/write.h - writes finished images: EXR scene-linear, PNG and JPEG through a display.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/unset_array.h"
#include "image/display.h"
#include "image/pixels.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// A finished image: interleaved float32, rows from the top, scene-linear Rec.709.
struct OutputImage {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  ///< "R","G","B","A" or e.g. "Z", "N.X","N.Y","N.Z"
    /// alpha premultiplied where there is an A
    UnsetArray<float> pixels;
    std::optional<ImagePart> part_of = {};  ///< none: the pixels are all there is
};

/// The image that a part belongs to, zero elsewhere.
OutputImage whole_image(const OutputImage& image);

/// Metadata of an image. An EXR has the attributes Software, asset, copyright,
/// samplesPerPixel (int), seed (text: it may need 64 bits), renderSeconds (float), worldToCamera,
/// worldToNDC (m44f), colorInteropID ("lin_rec709_scene" or "data"), chromaticities (colour only)
/// and the extra ones; PNG and JPEG have Software and Copyright.
struct ImageMetadata {
    std::string software;   ///< "Obscura 0.1.0"
    std::string asset;      ///< the asset's file name
    std::string copyright;  ///< asset.copyright, may be empty
    int samples_per_pixel = 0;
    uint64_t seed = 0;
    double render_seconds = 0;
    bool is_color = true;  ///< false: data such as depth; no chromaticities
    /// Row-major 4x4 for row vectors, as OpenEXR's standard attributes want them.
    float world_to_camera[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    bool has_ndc = true;  ///< false: the projection is no matrix, and none is written
    float world_to_ndc[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::vector<std::pair<std::string, std::string>> extra;  ///< further text attributes
};

enum class ExrDepth { half, float32 };

/// Writes `file` by its extension: .exr, .png, .jpg/.jpeg. Atomically: an existing file is replaced
/// completely or not at all.
///
/// EXR: ZIP; half values are clamped to +-65504 and NaN becomes 0, float32 values are kept. A part
/// of an image has its own data window inside the image's display window; the other formats have
/// none, and hold the whole image.
/// PNG, JPEG: 8 bits; colour goes through `display`, data (or no display) is taken as values
/// in [0, 1]. A PNG keeps straight alpha; a JPEG (quality 95) lies over black.
///
/// Errors  73 E-OUT-CREATE the folder is missing or not writable; 74 E-OUT-WRITE disk full or I/O;
///         64 E-OUT-FORMAT another extension, or channels that a PNG or JPEG cannot hold;
///         33 E-OUT-MEMORY; 70 E-OUT-ENCODE an inconsistent image
Result<void> write_image_file(const std::filesystem::path& file,
                              const OutputImage& image,
                              const ImageMetadata& metadata,
                              ExrDepth depth,
                              const DisplayTransform* display);

/// Checks before any work that `file` can be created: known extension, folder there and writable
/// (by creating and removing a temporary file), not a folder or device itself. Same errors.
Result<void> check_output(const std::filesystem::path& file);

}  // namespace obscura
