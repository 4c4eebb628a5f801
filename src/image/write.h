// image/write.h - writes finished images: EXR scene-linear, the others through a display.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/display_encoding.h"
#include "image/exr_options.h"
#include "image/image_metadata.h"
#include "image/layers.h"
#include "image/output_format.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// The image that a part belongs to, zero elsewhere; without layers, and without what a part that
/// is larger than it has around it.
OutputImage whole_image(const OutputImage& image);

/// The file of a layer of its own, beside the beauty's: shot.exr has shot.albedo.exr. A frame
/// number stays last: shot.0001.exr has shot.albedo.0001.exr.
std::filesystem::path layer_file(const std::filesystem::path& beauty, const std::string& layer);

/// A format, and the file's name for messages.
struct OutputTarget {
    OutputFormat format;
    std::string name;
};

/// A file in memory, and what it could not keep.
struct EncodedFile {
    std::vector<std::byte> bytes;
    WriteReport report = {};
};

/// Encodes an image in memory.
///
/// EXR: as `exr` says; half values are clamped to +-65504 and counted, and NaN becomes 0, float32
/// values are kept. A part of an image has its own data window inside the image's display window;
/// the other formats have none, and hold the whole image. They have no layers either.
/// All others: colour goes through the display's transform; data, and colour without a transform,
/// is taken as values in [0, 1]. PNG, TIFF, WebP and AVIF keep straight alpha unless there is a
/// page; a JPEG without one lies over black. Colours of an sRGB display are tagged as such: by a
/// chunk in a PNG, by a profile in JPEG, TIFF and WebP. Those of other displays have no tag, except
/// cICP in a PNG where the display has code points.
///
/// Out     one file: without the layers where they have files of their own
/// Errors  those of check_encoding; 64 E-OUT-FORMAT channels that only EXR can hold;
///         64 E-OUT-LAYER layers that no EXR can hold side by side;
///         33 E-OUT-MEMORY; 70 E-OUT-ENCODE an inconsistent image, or the encoder's own message
Result<EncodedFile> encode_image(const OutputTarget& target,
                                 const OutputImage& image,
                                 const ImageMetadata& metadata,
                                 const ExrOptions& exr,
                                 const DisplayEncoding& encoding);

/// Writes `file` in the format of its ending, atomically: an existing file is replaced completely
/// or not at all. Layers in files of their own are written before the beauty: where that is, all
/// are.
///
/// Errors  those of encode_image; 73 E-OUT-CREATE the folder is missing or not writable;
///         74 E-OUT-WRITE disk full or I/O; 64 E-OUT-FORMAT another ending
Result<WriteReport> write_image_file(const std::filesystem::path& file,
                                     const OutputImage& image,
                                     const ImageMetadata& metadata,
                                     const ExrOptions& exr,
                                     const DisplayEncoding& encoding);

/// A file, and what writes its bytes, whole or not at all.
struct FileToWrite {
    std::filesystem::path path;
    std::function<Result<void>(const std::filesystem::path&, std::span<const std::byte>)> write;
};

/// The same through another function than write_file_atomically, for each of the image's files.
///
/// Errors  likewise, and those of file.write
Result<WriteReport> write_image_file(const FileToWrite& file,
                                     const OutputImage& image,
                                     const ImageMetadata& metadata,
                                     const ExrOptions& exr,
                                     const DisplayEncoding& encoding);

/// Checks before any work that what writes a format is there; opens it, if need be.
///
/// Errors  69 E-OIIO
Result<void> check_writer(OutputFormat format);

/// Checks before any work that a format can hold an image of this size as it is asked for.
///
/// Errors  64 E-OUT-FORMAT a side is too long, or this build cannot write it (AVIF);
///         E-USAGE-CONFLICT more bits than it has
Result<void> check_encoding(const OutputTarget& target,
                            const DisplayEncoding& encoding,
                            int width,
                            int height);

/// What a file's name asks for.
///
/// Errors  64 E-OUT-FORMAT another ending
Result<OutputTarget> output_target(const std::filesystem::path& file);

/// Checks before any work that `file` can be created: known extension, folder there and writable
/// (by creating and removing a temporary file), not a folder or device itself.
///
/// Errors  64 E-OUT-FORMAT; 73 E-OUT-CREATE
Result<OutputTarget> check_output(const std::filesystem::path& file);

}  // namespace obscura
