// tests/layout/table_words.h - the rule that tables are read by the names of their members.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "layout/rules.h"
#include <regex>

namespace obscura::layout {

/// Refuses a literal number where a table's word is meant: record.integer(3), read3(record, 8),
/// words(4). Elements of a named member are fine: record.number<&Record::size>(2).
inline Problems check_table_words(std::string_view file, std::string_view text) {
    static const std::regex by_number(
        R"((\.(one_integer|varying_integer|integer|number|four_numbers)\s*\(\s*[0-9])"
        R"(|(^|[^.\w])read(3|_affine)?\s*\(([^()]*,\s*)?[0-9])"
        R"(|\bwords\s*\(\s*[0-9]))");
    Problems problems;
    const std::vector<std::string> lines = split_lines(text);
    for (size_t i = 0; i < lines.size(); ++i) {
        std::smatch found;
        if (!std::regex_search(lines[i], found, by_number)) continue;
        problems.push_back(problem(file,
                                   i + 1,
                                   {"`",
                                    found.str(),
                                    "`: read a table's member by its name, as in ",
                                    "record.number<&Material::roughness>()"}));
    }
    return problems;
}

}  // namespace obscura::layout
