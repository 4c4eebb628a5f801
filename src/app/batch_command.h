// app/batch_command.h - the subcommand `obscura batch`: a job of many pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/render_request.h"

#include <string>

namespace obscura::app {

/// The texts of the options as they stood on the command line.
struct BatchArguments {
    std::string job_file;
    bool dry_run = false;
    bool check = false;
    OptionText part;
    RenderArguments render;  ///< options that all pictures of the job get
};

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command batch_command(BatchArguments& arguments);

}  // namespace obscura::app
