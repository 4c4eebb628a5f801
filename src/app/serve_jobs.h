// app/serve_jobs.h - how `obscura serve` runs jobs: what its options mean for `obscura batch`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/serve_request.h"

namespace obscura::app {

/// Adds to the options of jobs what all pictures of the server get.
void complete_jobs_options(const RenderArguments& common, serve::JobsOptions& jobs);

}  // namespace obscura::app
