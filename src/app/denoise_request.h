// app/denoise_request.h - the request of `obscura denoise`, checked and ready to use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

#include <filesystem>
#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line.
struct DenoiseArguments {
    std::string file;
    std::vector<std::string> outputs;
    bool keep_noisy = false;
    RenderArguments render;  ///< of those that both commands have
};

struct DenoiseRequest {
    std::filesystem::path file;               ///< with render.frames a pattern, as outputs are
    std::vector<std::filesystem::path> exrs;  ///< may be `file` itself; of a sequence it may not
    bool keep_noisy = false;
    RenderRequest render;  ///< the outputs of other formats, their display, frames, threads
};

/// Errors  64 E-USAGE-CONFLICT no output, or a name of a sequence without a place for numbers;
///         E-USAGE-SAMEFILE two of one name; E-USAGE-CHOICE an exposure to be metered;
///         E-OUT-FORMAT; those of make_render_request
Result<DenoiseRequest> make_denoise_request(const DenoiseArguments& arguments);

}  // namespace obscura::app
