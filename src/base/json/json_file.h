// base/json/json_file.h - reads JSON files of people's own: views, cameras, jobs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/json/json_read.h"
#include "base/log.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace obscura {

/// Reads and parses a file.
///
/// In      missing: its id and where; its message says what the file is of and is completed
/// Errors  `missing` where the file cannot be read or has more than max_bytes; those of
///         parse_json_text
Result<nlohmann::json> read_json_file(const std::filesystem::path& file,
                                      uint64_t max_bytes,
                                      Error missing,
                                      Log& log);

/// Whether a file is there and is JSON to its end: one that was cut off is not.
bool is_whole_json(const std::filesystem::path& file);

/// Records a fault for a member that there is not, with those that there are.
void check_known_keys(const JsonReader& reader,
                      std::span<const std::string_view> known,
                      const char* id);

}  // namespace obscura
