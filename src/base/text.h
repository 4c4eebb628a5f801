// base/text.h - text helpers for messages and names.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace obscura {

/// True when the text consists of decimal digits only: an index rather than a name.
bool is_index(std::string_view text);

/// Whether a file's name is rather an address on the web, whose file nothing fetches.
bool is_web_address(std::string_view name);

constexpr const char* not_fetched = "nothing is fetched from the network; save it as a file first";

/// The text between single quotes, for messages.
std::string in_quotes(std::string_view text);

/// A number in its shortest form, for messages.
std::string shortest(double number);

}  // namespace obscura
