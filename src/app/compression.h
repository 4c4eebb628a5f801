// app/compression.h - the codec of OpenEXR files as --compression names it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/exr_options.h"

#include <array>
#include <string>

namespace obscura::app {

struct CompressionName {
    const char* name;
    ExrCompression value;
};

/// In the order of the enumeration.
inline constexpr std::array<CompressionName, 10> compression_names = {
    {{"none", ExrCompression::none},
     {"rle", ExrCompression::rle},
     {"zips", ExrCompression::zips},
     {"zip", ExrCompression::zip},
     {"piz", ExrCompression::piz},
     {"pxr24", ExrCompression::pxr24},
     {"b44", ExrCompression::b44},
     {"b44a", ExrCompression::b44a},
     {"dwaa", ExrCompression::dwaa},
     {"dwab", ExrCompression::dwab}}};

/// "zip", or "dwaa:60" with a level: sets the codec, and the level if there is one.
///
/// Errors  64 E-USAGE-CHOICE no such codec; E-USAGE-CONFLICT a level of another than dwaa and dwab;
///         E-USAGE-NUMBER, E-USAGE-RANGE the level is none from 0 to 100000
Result<void> parse_compression(const std::string& text, const std::string& option, ExrOptions& exr);

}  // namespace obscura::app
