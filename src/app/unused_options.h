// app/unused_options.h - options that change nothing beside the others that are given.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"
#include "base/log.h"

namespace obscura::app {

/// Warns of options that are for other outputs or layers than the request has: they are harmless,
/// but what was meant does not happen.
void warn_of_unused_options(const RenderArguments& arguments,
                            const RenderRequest& request,
                            Log& log);

}  // namespace obscura::app
