// app/unused_options.h - options that change nothing beside the others that are given.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"
#include "base/log.h"

#include <string>
#include <vector>

namespace obscura::app {

struct UnusedOption {
    std::string name;  ///< long, with its dashes
    std::string why;
};

/// The options that are for other outputs, layers or integrators than the request has: they are
/// harmless, but what was meant does not happen.
std::vector<UnusedOption> unused_options(const RenderArguments& arguments,
                                         const RenderRequest& request);

/// Warns of them.
void warn_of_unused_options(const std::vector<UnusedOption>& unused, Log& log);

}  // namespace obscura::app
