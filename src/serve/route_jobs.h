// serve/route_jobs.h - the HTTP routes of jobs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/http.h"
#include "serve/jobs.h"

namespace obscura::serve {

/// Adds /api/jobs and what is below it (docs/serve_jobs.md).
///
/// In      jobs: outlives the routes
void route_jobs(Routes& routes, Jobs& jobs);

}  // namespace obscura::serve
