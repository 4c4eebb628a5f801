// base/json/json.cpp - JSON values for reports, and their text.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json.h"

namespace obscura {

namespace {

/// In   indent: -1: one line
std::string text_of(const Json& json, int indent) {
    return escape_json_controls(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

std::string json_document(const Json& json) {
    constexpr int indent = 2;
    return text_of(json, indent) + '\n';
}

std::string json_line(const Json& json) {
    return text_of(json, -1);
}

std::string escape_json_controls(std::string_view text) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        auto code = static_cast<unsigned char>(text[i]);
        // U+0080 to U+009F are two bytes, of which the second one is the code.
        const bool two = code == 0xC2 && i + 1 < text.size();
        if (two) code = static_cast<unsigned char>(text[i + 1]);
        if (two ? code < 0xA0 : code == 0x7F) {
            out += "\\u00";
            out += hex[code >> 4];
            out += hex[code & 15];
            i += two ? 1 : 0;
        } else {
            out += text[i];
        }
    }
    return out;
}

}  // namespace obscura
