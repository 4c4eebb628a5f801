// tests/layout/standard_names.h - which header a name of the standard library comes from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "layout/rules.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace obscura::layout {

struct StandardNames {
    std::string_view header;
    std::string_view names;  ///< behind std::, separated by spaces
};

/// What precompiled headers and joined files would hide most often. Of <utility>, <cstddef> and
/// other headers that come with nearly each of these nothing is asked.
inline constexpr std::array<StandardNames, 28> standard_names{
    {{"algorithm",
      "all_of any_of clamp copy copy_n count_if fill fill_n find find_if lower_bound max "
      "max_element min min_element none_of remove_if reverse sort transform upper_bound"},
     {"array", "array"},
     {"atomic", "atomic"},
     {"bit", "bit_cast endian has_single_bit popcount"},
     {"charconv", "from_chars to_chars"},
     {"chrono", "chrono"},
     {"cmath",
      "abs acos asin atan atan2 ceil cos cosh exp exp2 floor fmod hypot isfinite isnan log log10 "
      "log2 lround pow round sin sinh sqrt tan"},
     {"condition_variable", "condition_variable"},
     {"cstdio", "FILE fclose fflush fopen fprintf fputs printf"},
     {"cstring", "memcmp memcpy memmove memset strlen"},
     {"filesystem", "filesystem"},
     {"fstream", "ifstream ofstream"},
     {"functional", "function"},
     {"limits", "numeric_limits"},
     {"map", "map multimap"},
     {"memory", "make_shared make_unique shared_ptr unique_ptr weak_ptr"},
     {"mutex", "lock_guard mutex scoped_lock unique_lock"},
     {"numeric", "accumulate iota"},
     {"optional", "nullopt optional"},
     {"set", "multiset set"},
     {"span", "span"},
     {"sstream", "istringstream ostringstream stringstream"},
     {"string", "string to_string"},
     {"string_view", "string_view"},
     {"thread", "jthread thread this_thread"},
     {"unordered_map", "unordered_map"},
     {"variant", "get_if holds_alternative variant visit"},
     {"vector", "vector"}}};

/// "std::" and the name, for each in the text; with the line of the first.
inline std::map<std::string, size_t> names_of_std(std::string_view text) {
    constexpr std::string_view prefix = "std::";
    const std::string code = code_only(text);
    const auto is_part = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    std::map<std::string, size_t> out;
    for (size_t at = code.find(prefix); at != std::string::npos; at = code.find(prefix, at + 1)) {
        if (at > 0 && is_part(code[at - 1])) continue;
        const auto begin = code.begin() + static_cast<ptrdiff_t>(at + prefix.size());
        const std::string name(begin, std::find_if_not(begin, code.end(), is_part));
        const auto lines = std::count(code.begin(), begin, '\n');
        out.emplace(name, static_cast<size_t>(lines) + 1);
    }
    return out;
}

/// All headers of libraries that a file of src/ includes, itself or by way of others of src/.
///
/// In      includes: of each file of src/, by its name
inline std::set<std::string> library_headers_of(
    const std::string& file, const std::map<std::string, std::vector<Include>>& includes) {
    std::set<std::string> out;
    std::set<std::string> seen = {file};
    std::vector<std::string> left = {file};
    while (!left.empty()) {
        const auto found = includes.find(left.back());
        left.pop_back();
        if (found == includes.end()) continue;
        for (const Include& include : found->second) {
            if (!include.quoted) out.insert(include.path);
            if (include.quoted && seen.insert(include.path).second) left.push_back(include.path);
        }
    }
    return out;
}

/// Names of the standard library whose header a file does not get from anywhere.
///
/// In      headers: those of library_headers_of
inline Problems check_standard_names(std::string_view file,
                                     std::string_view text,
                                     const std::set<std::string>& headers) {
    const std::map<std::string, size_t> used = names_of_std(text);
    Problems problems;
    for (const StandardNames& known : standard_names) {
        if (headers.count(std::string(known.header)) != 0) continue;
        for (const auto& [name, line] : used) {
            if (!has_word(known.names, name)) continue;
            problems.push_back(
                problem(file, line, {"std::", name, " needs #include <", known.header, ">"}));
            break;
        }
    }
    return problems;
}

}  // namespace obscura::layout
