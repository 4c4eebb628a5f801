// app/long_run_options.h - the options for renderings that take hours and may be cut short.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"

namespace obscura {
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

struct RenderArguments;

/// The texts of these options as they stood on the command line.
struct LongRunArguments {
    OptionText checkpoint, interval, resume, time_limit, snapshot;
    bool skip_existing = false;
    bool keep_checkpoint = false;
};

/// Refuses what cannot be kept or shown before it is done.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> complete_long_run(RenderRequest& request);

OptionGroup<RenderArguments, RenderRequest> long_run_group();

}  // namespace obscura::app
