// app/time_options.h - the options for animations and sequences: a table.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "session/render_request.h"

namespace obscura::app {

struct RenderArguments;

OptionGroup<RenderArguments, RenderRequest> time_group();

}  // namespace obscura::app
