// base/name_search.h - finds names by a pattern or near a mistyped one, and tells equal ones apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// True when the whole name fits the pattern: * stands for any text, ? for one byte, all else for
/// itself.
bool fits_pattern(std::string_view pattern, std::string_view name);

/// Fewest insertions, removals and replacements of a byte that turn one word into the other.
size_t edit_distance(std::string_view a, std::string_view b);

/// For a message about a name that is not there: " (did you mean 'Lamp'?)", else the names that
/// there are, else that there are none: "; there are 'Key', 'Rim' and 7 more". Equal names count
/// once, in the order they come; upper and lower case are alike.
///
/// In      things: what the names are of, in the plural: "lights"
std::string names_instead(std::string_view wanted,
                          const std::vector<std::string>& names,
                          std::string_view things);

/// The names near to a mistyped one, as above; empty: there are none.
std::string near_names(std::string_view wanted, const std::vector<std::string>& names);

/// The texts, made different by -2, -3 and so on behind those that were there before.
std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace obscura
