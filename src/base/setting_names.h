// base/setting_names.h - spells the names of settings in messages, for whom they are meant.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace obscura {

/// How a message spells the names of settings.
enum class SettingNames {
    plain,   ///< "focus_distance": of jobs and of the server
    fields,  ///< "focus_distance_m": of the library and of Python, with their units
    options  ///< "--focus-distance": for people at the command line
};

/// The marked name of a setting, for an error or a log message; spell_settings spells it when the
/// message is shown.
///
/// In      name: words joined by hyphens: "focus-distance"
std::string setting(std::string_view name);

/// A text with the marked names of settings spelled out.
std::string spell_settings(std::string_view text, SettingNames names);

}  // namespace obscura
