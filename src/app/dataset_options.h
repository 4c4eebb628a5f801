// app/dataset_options.h - the table of the options of `obscura dataset`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/dataset_request.h"

namespace obscura::app {

using DatasetOptionGroup = OptionGroup<DatasetArguments, DatasetRequest>;

/// The command's own options.
std::span<const DatasetOptionGroup> dataset_option_groups();

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command dataset_command(DatasetArguments& arguments);

}  // namespace obscura::app
