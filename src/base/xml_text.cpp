// base/xml_text.cpp - escapes text for XML and HTML (drawings, pages).
// SPDX-License-Identifier: Apache-2.0
#include "base/xml_text.h"

namespace obscura {

std::string escape_xml(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return out;
}

}  // namespace obscura
