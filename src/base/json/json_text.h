// base/json/json_text.h - parses JSON text with limits, and with positions in errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace obscura {

inline constexpr int max_json_depth = 128;

/// Parses UTF-8 JSON without recursion. A byte order mark and repeated keys (the last one counts)
/// are accepted with a warning.
///
/// Errors  65 E-JSON-SYNTAX with line and column (also NaN, 1e999, invalid UTF-8, trailing text),
///         65 E-JSON-DEPTH nested deeper than max_json_depth, 65 E-JSON-ROOT not an object
Result<nlohmann::json> parse_json_text(std::string_view text, const std::string& where, Log& log);

}  // namespace obscura
