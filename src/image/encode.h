// image/encode.h - encodes finished images in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/oiio_module.h"
#include "image/write.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// Encodes an image as an OpenEXR file: with its layers, unless they have files of their own. The
/// same image gives the same bytes on any number of threads. OpenEXR's exceptions pass through.
EncodedFile encode_exr(const OutputImage& image,
                       const ImageMetadata& metadata,
                       const ExrOptions& options,
                       const std::string& name);

/// Encodes one of the image's layers as a file of its own. As encode_exr.
EncodedFile encode_exr_layer(const OutputImage& image,
                             const ImageLayer& layer,
                             const ImageMetadata& metadata,
                             const ExrOptions& options,
                             const std::string& name);

/// Encodes a whole image of 1, 3 or 4 channels for a display; see write_image_file.
///
/// In      target: of any format but EXR
/// Errors  70 E-OUT-ENCODE with the library's message
Result<std::vector<std::byte>> encode_for_display(const OutputTarget& target,
                                                  const OutputImage& image,
                                                  const ImageMetadata& metadata,
                                                  const DisplayEncoding& encoding);

/// Numbers that are no colours: what is written is what is read, without a display, an alpha to
/// divide by or anything beside the pixels.
struct ExactImage {
    int width = 0, height = 0, channels = 0;
    OiioType type = OiioType::uint8;
    const void* codes = nullptr;  ///< interleaved
};

/// Encodes numbers: as PNG, which has 8 and 16 bits, or as TIFF, which has floats too.
///
/// Errors  69 E-OIIO, for TIFF; 70 E-OUT-ENCODE with the library's message
Result<std::vector<std::byte>> encode_exact(const OutputTarget& target, const ExactImage& image);

/// Interleaved codes of an image: grey, RGB, or RGB and straight alpha.
struct CodedImage {
    int width = 0, height = 0, channels = 0;
    const uint8_t* codes = nullptr;
};

/// An image to encode as PNG, and what is said about it.
struct PngImage {
    int width = 0, height = 0, channels = 0;
    int bits = 8;                 ///< or 16
    const void* codes = nullptr;  ///< interleaved; alpha is straight
    std::optional<ColorCodePoints> code_points = {};
    std::vector<std::pair<std::string, std::string>> texts = {};
};

/// Encodes as PNG through libpng, with a chunk sRGB for colours of that encoding, cICP for those of
/// another, neither for none.
///
/// Errors  70 E-OUT-ENCODE with the library's message
Result<std::vector<std::byte>> encode_png(const PngImage& image, const std::string& where);

/// The fingerprint in a PNG's texts; "": it has none. Nothing: it is no PNG, or it is cut off.
std::optional<std::string> fingerprint_of_png(const std::vector<std::byte>& file);

/// Encodes as WebP through libwebp: with loss below quality 100, without at 100.
///
/// In      image: 3 or 4 channels; is_srgb: adds the profile of sRGB; metadata: its texts become an
///         XMP packet
/// Errors  70 E-OUT-ENCODE
Result<std::vector<std::byte>> encode_webp(const CodedImage& image,
                                           int quality,
                                           bool is_srgb,
                                           const ImageMetadata& metadata,
                                           const std::string& where);

/// The fingerprint in a WebP's XMP packet; "": it has none. Nothing: it is no WebP.
std::optional<std::string> fingerprint_of_webp(const std::vector<std::byte>& file);

/// Encodes as AVIF through OpenImageIO, which needs a file for that: one of its own in the folder
/// for temporary files, removed in the end.
///
/// In      image: 3 or 4 channels
/// Errors  70 E-OUT-ENCODE, 74 E-OUT-WRITE
Result<std::vector<std::byte>> encode_avif(const CodedImage& image,
                                           int quality,
                                           const std::string& where);

/// True when OpenImageIO, as it is installed, writes AVIF: asks by writing a small one, once.
bool can_write_avif();

}  // namespace obscura
