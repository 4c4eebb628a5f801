// app/config_file.h - reads the file of --config, whose options the command line overrides.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "base/error.h"

#include <string>
#include <vector>

namespace obscura::app {

/// One "key = value" of the file.
struct ConfigItem {
    std::vector<std::string> section = {};
    std::string key = {};
    std::vector<std::string> values = {};
};

/// The option --config, which every command has.
BoundOption config_option(OptionText& target);

/// The file's text without comments: from # to the end of a line, where it does not stand in
/// quotes or inside a word.
///
/// Errors  66 E-CONFIG-MISSING
Result<std::string> read_config_text(const std::string& file);

/// Gives each option of the file its text, unless it has one already or excludes one that was
/// given. Keys are the options' names without dashes; those below [render] are for that command
/// only and override those of the whole file.
///
/// Errors  64 E-CONFIG-KEY no option of that name, a repeated one, or a section of no command;
///         E-CONFIG-VALUE several values, or a flag that is neither true nor false
Result<void> apply_config(const std::string& file,
                          const std::vector<ConfigItem>& items,
                          const Command& command,
                          const Program& program);

}  // namespace obscura::app
