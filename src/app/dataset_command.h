// app/dataset_command.h - the subcommand `obscura dataset`: images with labels from random views.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/dataset_request.h"

namespace obscura::app {

/// Renders a data set and prints messages. Returns the exit code.
int run_dataset(const DatasetArguments& arguments);

}  // namespace obscura::app
