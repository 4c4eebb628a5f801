// app/info_command.h - the subcommand `obscura info`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace obscura::app {

struct InfoArguments {
    std::string scene_file;
    std::optional<std::string> scene, variant;
    bool explain = false;
    bool json = false;
    bool quiet = false;
    bool lenient = false;
};

/// Prints the contents of the file, or their support, as a table or as JSON. Returns the exit code.
int run_info(const InfoArguments& arguments);

}  // namespace obscura::app
