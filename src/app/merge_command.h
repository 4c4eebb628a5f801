// app/merge_command.h - the subcommand `obscura merge`: parts of a picture become the picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"

#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line.
struct MergeArguments {
    std::vector<std::string> parts, outputs;
    bool quiet = false;
};

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command merge_command(MergeArguments& arguments);

}  // namespace obscura::app
