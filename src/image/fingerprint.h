// image/fingerprint.h - the fingerprint of what an image file was made from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/image_metadata.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace obscura {

/// The attribute of EXRs and PNGs, and a property in the XMP of WebPs; in the description of JPEGs
/// and TIFFs, which have no names of one's own, "obscura:fingerprint=0123456789abcdef".
inline constexpr std::string_view fingerprint_name = "obscura:fingerprint";

/// The fingerprint in an image's metadata; "": it has none.
std::string fingerprint_of(const ImageMetadata& metadata);

/// The fingerprint that a file's header holds; "": the header has none. Nothing: there is no such
/// file, it cannot be read, or its end has been cut off.
std::optional<std::string> read_fingerprint(const std::filesystem::path& file);

}  // namespace obscura
