// image/write.h - writes finished images: EXR scene-linear, the others through a display.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/unset_array.h"
#include "image/display_encoding.h"
#include "image/output_format.h"
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
/// and the extra ones; PNG, JPEG and TIFF have Software and Copyright.
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

/// A format, and the file's name for messages.
struct OutputTarget {
    OutputFormat format;
    std::string name;
};

/// Encodes an image in memory.
///
/// EXR: ZIP; half values are clamped to +-65504 and NaN becomes 0, float32 values are kept. A part
/// of an image has its own data window inside the image's display window; the other formats have
/// none, and hold the whole image.
/// All others: colour goes through the display's transform; data, and colour without a transform,
/// is taken as values in [0, 1]. PNG, TIFF, WebP and AVIF keep straight alpha unless there is a
/// page; a JPEG without one lies over black. Colours of an sRGB display are tagged as such: by a
/// chunk in a PNG, by a profile in JPEG, TIFF and WebP. Those of other displays have no tag, except
/// cICP in a PNG where the display has code points.
///
/// Errors  those of check_encoding; 64 E-OUT-FORMAT channels that only EXR can hold;
///         33 E-OUT-MEMORY; 70 E-OUT-ENCODE an inconsistent image, or the encoder's own message
Result<std::vector<std::byte>> encode_image(const OutputTarget& target,
                                            const OutputImage& image,
                                            const ImageMetadata& metadata,
                                            ExrDepth depth,
                                            const DisplayEncoding& encoding);

/// Writes `file` in the format of its ending, atomically: an existing file is replaced completely
/// or not at all.
///
/// Errors  those of encode_image; 73 E-OUT-CREATE the folder is missing or not writable;
///         74 E-OUT-WRITE disk full or I/O; 64 E-OUT-FORMAT another ending
Result<void> write_image_file(const std::filesystem::path& file,
                              const OutputImage& image,
                              const ImageMetadata& metadata,
                              ExrDepth depth,
                              const DisplayEncoding& encoding);

/// Checks before any work that a format can hold an image of this size as it is asked for.
///
/// Errors  64 E-OUT-FORMAT a side is too long, or this build cannot write it (AVIF);
///         E-USAGE-CONFLICT more bits than it has
Result<void> check_encoding(const OutputTarget& target,
                            const DisplayEncoding& encoding,
                            int width,
                            int height);

/// Checks before any work that `file` can be created: known extension, folder there and writable
/// (by creating and removing a temporary file), not a folder or device itself.
///
/// Errors  64 E-OUT-FORMAT; 73 E-OUT-CREATE
Result<OutputTarget> check_output(const std::filesystem::path& file);

}  // namespace obscura
