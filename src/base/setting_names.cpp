// base/setting_names.cpp - what a setting is called in a message, for each who may read it.
// SPDX-License-Identifier: Apache-2.0
#include "base/setting_names.h"

#include <algorithm>

namespace obscura {

namespace {

/// Stands before a name: the unit separator, which no sentence has.
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
