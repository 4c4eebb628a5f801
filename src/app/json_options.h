// app/json_options.h - options as JSON has them: names without dashes, values of any plain type.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "base/json/json.h"

#include <string>
#include <vector>

namespace obscura::app {

/// In      name: with its dashes
/// Out     null: there is no such option
const BoundOption* find_option(const std::vector<BoundOption>& table, const std::string& name);

/// Sets an option to a string, a number, true, false or an array of these. "": done, else what is
/// expected.
std::string set_from_json(const BoundOption& option, const nlohmann::json& value);

/// The words of a command line that say the same.
///
/// In      value: one that set_from_json takes
std::vector<std::string> words_from_json(const BoundOption& option, const nlohmann::json& value);

}  // namespace obscura::app
