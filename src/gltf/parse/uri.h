// gltf/parse/uri.h - the bytes of a data URI, or of a file in the asset's folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/file_bytes.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace obscura::gltf {

/// Where URIs are resolved and what is said about them.
struct UriContext {
    std::filesystem::path folder;  ///< the asset's
    std::string where;             ///< file with JSON pointer, for messages
};

struct UriBytes {
    Bytes bytes;
    std::string mime;   ///< of a data URI, else empty
    uint64_t size = 0;  ///< of the file; `bytes` may hold less
};

bool is_data_uri(std::string_view uri);

/// Replaces %XX once; a % that two hexadecimal digits do not follow stays.
std::string percent_decode(std::string_view text);

/// Decodes standard base64, padded or not. An empty message is success.
std::string decode_base64(std::string_view text, Bytes& out);

/// Turns a relative URI into a path, by its text alone: nothing that leaves the asset's folder, no
/// scheme, no drive, no backslash, no control character.
///
/// Errors  77 E-URI-REFUSED
Result<std::filesystem::path> relative_path_from_uri(std::string_view uri,
                                                     const std::string& where);

/// Reads what a URI names. Symbolic links are followed as long as they stay inside the folder.
///
/// Errors  77 E-URI-REFUSED, E-LIMIT-FILE; 67 E-RES-MISSING; 65 E-URI-DATA; that of limits.charge
Result<UriBytes> read_uri(std::string_view uri,
                          const UriContext& context,
                          const ReadLimits& limits);

}  // namespace obscura::gltf
