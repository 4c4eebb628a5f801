// base/setting_names.h - what a setting is called in a message, for each who may read it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace obscura {

/// How a message names what its reader can set.
enum class SettingNames {
    plain,   ///< "focus_distance": for programs that fill in fields
    options  ///< "--focus-distance": for people at the command line
};

/// The name of a setting as part of an error's place or text, or of a message in the log; who shows
/// it spells it. In  name: words joined by hyphens: "focus-distance"
std::string setting(std::string_view name);

/// A text with its settings' names spelled out; one without them stays as it is.
std::string spell_settings(std::string_view text, SettingNames names);

}  // namespace obscura
