// base/setting_names.h - spells the names of settings in messages, for API or command line.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace obscura {

/// How a message spells the names of settings.
enum class SettingNames {
    plain,   ///< "focus_distance": for programs that fill in fields
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
