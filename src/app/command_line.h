// app/command_line.h - parses the command line into option texts.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "base/error.h"

#include <string>

namespace obscura::app {

/// The result of parsing a command line.
struct CommandLine {
    const Command* command = nullptr;  ///< its options are filled; null: `text` is the answer
    std::string text = {};             ///< help or version
};

/// Fills the options of the given command, including those of --config.
///
/// Errors  64 E-USAGE, and those of apply_config
Result<CommandLine> parse_command_line(const Program& program, int argc, const char* const* argv);

/// What to say of a word that is one too many and looks like a number; "" of others.
std::string commas_hint(const std::string& word);

/// The option whose name is closest to the typed one; "": none is close.
std::string nearest_option(const Command& command, const std::string& typed);

}  // namespace obscura::app
