// app/noise_options.h - the options for adaptive sampling and against fireflies: tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "app/option_readers.h"
#include "session/render_request.h"

#include <string>

namespace obscura::app {

struct RenderArguments;

/// Reads a number of samples, or `auto`, which turns adaptive sampling on.
///
/// Errors  64 E-USAGE-NUMBER
Result<void> read_samples(const OptionInfo& info, const std::string& text, RenderRequest& request);

/// Of --spp.
inline constexpr OptionReader<RenderRequest> samples_or_auto = {
    .read = read_samples,
    .show = show_number<&RenderRequest::options, &RenderOptions::samples_per_pixel>};

OptionGroup<RenderArguments, RenderRequest> adaptive_group();
OptionGroup<RenderArguments, RenderRequest> fireflies_group();

}  // namespace obscura::app
