// base/text.cpp - text helpers for messages and names.
// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <algorithm>
#include <charconv>

namespace obscura {

bool is_index(std::string_view text) {
    return !text.empty() &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_web_address(std::string_view name) {
    return name.substr(0, 4) == "http" && name.find(":/") != std::string_view::npos;
}

std::string in_quotes(std::string_view text) {
    return std::string("'").append(text).append("'");
}

std::string shortest(double number) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
    return {buffer, end};
}

}  // namespace obscura
