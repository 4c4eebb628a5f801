// app/command_line.h - from the words of the command line to the texts of options.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "base/error.h"

#include <string>

namespace obscura {

/// What came of a command line.
struct CommandLine {
    const Command* command = nullptr;  ///< its options are filled; null: `text` is the answer
    std::string text = {};             ///< help or version
};

/// Fills the options of the command that was given, those of --config too.
///
/// Errors  64 E-USAGE, and those of apply_config
Result<CommandLine> parse_command_line(const Program& program, int argc, const char* const* argv);

/// The option whose name is nearest to what was typed; "": none is near.
std::string nearest_option(const Command& command, const std::string& typed);

}  // namespace obscura
