// base/setting_names.cpp - spells the names of settings in messages, for API or command line.
// SPDX-License-Identifier: Apache-2.0
#include "base/setting_names.h"

#include <algorithm>

namespace obscura {

namespace {

/// Marks a name: the unit separator, which occurs in no sentence.
constexpr char mark = '\x1f';

bool is_of_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

std::string setting(std::string_view name) {
    return std::string(1, mark).append(name);
}

std::string spell_settings(std::string_view text, SettingNames names) {
    std::string out;
    for (size_t i = 0; i < text.size();) {
        if (text[i] != mark) {
            out += text[i++];
            continue;
        }
        const size_t begin = ++i;
        while (i < text.size() && is_of_name(text[i]))
            ++i;
        std::string name(text.substr(begin, i - begin));
        if (names == SettingNames::options) {
            out += "--" + name;
        } else {
            std::replace(name.begin(), name.end(), '-', '_');
            out += name;
        }
    }
    return out;
}

}  // namespace obscura
