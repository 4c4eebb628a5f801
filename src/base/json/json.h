// base/json/json.h - JSON values for reports, and their text.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace obscura {

/// An object keeps its members in the order in which they are added.
using Json = nlohmann::ordered_json;

/// The document's text, indented by two spaces, with a line feed at its end; the same in every
/// locale. Numbers keep their exact values, NaN and infinity become null. Control characters are
/// escaped, bytes that are not UTF-8 become U+FFFD.
std::string json_document(const Json& json);

}  // namespace obscura
