// base/name_search.cpp - finds names by a pattern, and those that a mistyped one is near to.
// SPDX-License-Identifier: Apache-2.0
#include "base/name_search.h"

#include "base/text.h"

#include <algorithm>
#include <set>

namespace obscura {

namespace {

constexpr size_t max_listed = 8;

std::string lower_case(std::string_view text) {
    std::string out(text);
    for (char& c : out) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return out;
}

/// One slip in a short name, two in a longer one; or one name is a part of the other.
bool is_near(const std::string& wanted, const std::string& name) {
    constexpr size_t short_name = 4;
    if (wanted.empty() || name.empty()) return false;
    if (wanted.size() >= short_name && name.find(wanted) != std::string::npos) return true;
    if (name.size() >= short_name && wanted.find(name) != std::string::npos) return true;
    return edit_distance(wanted, name) <= (wanted.size() < short_name ? 1U : 2U);
}

/// Each name of the first ones once.
std::vector<std::string> different(const std::vector<std::string>& names, size_t count) {
    std::set<std::string_view> seen;
    std::vector<std::string> out;
    for (size_t i = 0; i < std::min(names.size(), count); ++i) {
        if (seen.insert(names[i]).second) out.push_back(names[i]);
    }
    return out;
}

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (size_t i = 0; i < std::min(names.size(), max_listed); ++i)
        out += (i == 0 ? "" : ", ") + in_quotes(names[i]);
    if (names.size() > max_listed)
        out += " and " + std::to_string(names.size() - max_listed) + " more";
    return out;
}

}  // namespace

bool fits_pattern(std::string_view pattern, std::string_view name) {
    size_t p = 0;
    size_t n = 0;
    size_t after_star = std::string_view::npos;  // where to go on when the text of a * grows
    size_t star_end = 0;                         // of the name, behind that text
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            after_star = ++p;
            star_end = n;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
            ++p;
            ++n;
        } else if (after_star != std::string_view::npos) {
            p = after_star;
            n = ++star_end;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*')
        ++p;
    return p == pattern.size();
}

size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row.back();
}

std::string near_names(std::string_view wanted, const std::vector<std::string>& names) {
    constexpr size_t max_compared = 10000;  // comparing takes the product of the lengths
    std::vector<std::string> near;
    for (const std::string& name : different(names, max_compared)) {
        if (is_near(lower_case(wanted), lower_case(name))) near.push_back(name);
    }
    return near.empty() ? "" : " (did you mean " + listed(near) + "?)";
}

std::string names_instead(std::string_view wanted,
                          const std::vector<std::string>& names,
                          std::string_view things) {
    if (const std::string near = near_names(wanted, names); !near.empty()) return near;
    const std::vector<std::string> all = different(names, names.size());
    if (all.empty()) return "; there are no " + std::string(things);
    return "; the " + std::string(things) + " are " + listed(all);
}

std::vector<std::string> distinct_names(std::vector<std::string> names) {
    std::set<std::string> taken(names.begin(), names.end());
    std::set<std::string> used;
    for (std::string& name : names) {
        if (used.insert(name).second) continue;
        const std::string stem = name;
        for (int number = 2; !taken.insert(name).second; ++number)
            name = stem + "-" + std::to_string(number);
        used.insert(name);
    }
    return names;
}

}  // namespace obscura
