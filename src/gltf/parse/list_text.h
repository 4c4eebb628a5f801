// gltf/parse/list_text.h - many names in one message.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace obscura::gltf {

/// "a, b, c and 7 more".
inline std::string list_text(const std::vector<std::string>& names) {
    constexpr size_t max_count = 8;
    std::string out;
    for (size_t i = 0; i < std::min(names.size(), max_count); ++i) {
        if (i != 0) out += ", ";
        out += names[i];
    }
    if (names.size() > max_count)
        out += " and " + std::to_string(names.size() - max_count) + " more";
    return out;
}

/// Names in the order they came, neighbours once, for one warning of many.
class NameList {
public:
    void add(const std::string& name) {
        if (names_.empty() || names_.back() != name) names_.push_back(name);
    }
    bool empty() const { return names_.empty(); }
    std::string text() const { return list_text(names_); }

private:
    std::vector<std::string> names_;
};

}  // namespace obscura::gltf
