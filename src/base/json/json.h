// base/json/json.h - JSON values for reports, and their text.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace obscura {

/// An object keeps its members in the order in which they are added.
using Json = nlohmann::ordered_json;

/// The document's text, indented by two spaces, with a line feed at its end; the same in every
/// locale. Numbers keep their exact values, NaN and infinity become null. Control characters are
/// escaped, those that JSON allows too; bytes that are not UTF-8 become U+FFFD.
std::string json_document(const Json& json);

/// The same on one line, without its end.
std::string json_line(const Json& json);

/// JSON text whose strings have U+007F to U+009F escaped, too: JSON allows these control
/// characters, but terminals act on them, and what escapes them for terminals writes no JSON.
///
/// In      text: valid JSON, UTF-8
std::string escape_json_controls(std::string_view text);

}  // namespace obscura
