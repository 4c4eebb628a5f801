// image/output_format.h - the formats that images are written in, and what each of them can hold.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace obscura {

enum class OutputFormat { exr, png, jpeg, tiff, webp, avif };

/// What is to be known about a format before its encoder is asked.
///
/// To add a format: an enumerator, an entry here, an encoder in encode.h that encode_image calls,
/// and a round trip in tests/image/encode_display_test.cpp.
struct OutputFormatEntry {
    const char* name;  ///< as --format and OpenImageIO call it
    OutputFormat value;
    std::array<const char*, 2> endings;  ///< of files, in lower case; null: there is one only
    int max_side;                        ///< pixels
    int max_bits;                        ///< of a channel of an image for a display
    bool has_alpha;                      ///< an image for a display keeps its alpha
    bool has_texts;                      ///< it keeps texts beside the pixels
    int quality;                         ///< unless another is asked for; 0: nothing is lost
};

/// Sources of the greatest sides: libjpeg's JPEG_MAX_DIMENSION, libwebp's WEBP_MAX_DIMENSION.
inline constexpr std::array output_formats = {
    OutputFormatEntry{"exr", OutputFormat::exr, {".exr", nullptr}, 1 << 20, 16, true, true, 0},
    OutputFormatEntry{"png", OutputFormat::png, {".png", nullptr}, 1 << 20, 16, true, true, 0},
    OutputFormatEntry{"jpeg", OutputFormat::jpeg, {".jpg", ".jpeg"}, 65500, 8, false, true, 95},
    OutputFormatEntry{"tiff", OutputFormat::tiff, {".tif", ".tiff"}, 1 << 20, 16, true, true, 0},
    OutputFormatEntry{"webp", OutputFormat::webp, {".webp", nullptr}, 16383, 8, true, true, 90},
    OutputFormatEntry{"avif", OutputFormat::avif, {".avif", nullptr}, 65536, 8, true, false, 90}};

const OutputFormatEntry& entry_of(OutputFormat format) noexcept;

/// The format of a file's name by its ending, in upper or lower case; none: it is not written.
std::optional<OutputFormat> output_format_of(const std::filesystem::path& file);

/// ".exr, .png, .jpg, .jpeg, ... and .avif".
std::string output_endings();

}  // namespace obscura
