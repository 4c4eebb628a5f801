// tests/support/xml_text.h - whether a document is well-formed, as far as ours need it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <regex>
#include <string>
#include <vector>

namespace obscura::test {

/// True when every element is closed in order and no bare & or < is left; for documents without
/// comments and CDATA.
inline bool is_well_formed(const std::string& text) {
    std::vector<std::string> open;
    const std::regex tag(R"(<(\?|/)?([a-zA-Z]+)((?:\s[a-zA-Z0-9:-]+="[^"<]*")*)\s*(\?|/)?>)");
    std::string between;
    auto end = text.begin();
    for (std::sregex_iterator it(text.begin(), text.end(), tag), last; it != last; ++it) {
        between += std::string(end, (*it)[0].first);
        end = (*it)[0].second;
        const std::string before = (*it)[1];
        const std::string after = (*it)[4];
        if (before == "/") {
            if (open.empty() || open.back() != (*it)[2]) return false;
            open.pop_back();
        } else if (before.empty() && after.empty()) {
            open.push_back((*it)[2]);
        }
    }
    between += std::string(end, text.end());
    const std::regex bare(R"([<>]|&(?!amp;|lt;|gt;|quot;))");
    return open.empty() && !std::regex_search(between, bare);
}

}  // namespace obscura::test
