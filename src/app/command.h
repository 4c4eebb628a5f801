// app/command.h - a subcommand: its name, its options, its help.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"

#include <functional>
#include <string>
#include <vector>

namespace obscura::app {

struct Command {
    const char* name = "";
    const char* summary = "";  ///< one line
    const char* notes = "";    ///< below the options: explanations and examples
    std::vector<BoundOption> options = {};
    std::function<int()> run = {};  ///< once the options are parsed; returns the exit code
    bool hidden = false;            ///< not named in the help of the program
};

/// All subcommands of the program with the texts of their options.
struct Program {
    const char* name = "";
    const char* summary = "";
    const char* notes = "";
    std::string version = {};
    std::vector<Command> commands = {};
};

}  // namespace obscura::app
