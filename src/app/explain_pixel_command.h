// app/explain_pixel_command.h - the subcommand `obscura explain-pixel`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"
#include "explain/explain_pixel.h"

#include <filesystem>
#include <optional>
#include <string>

namespace obscura::app {

/// The texts of the options as they stood on the command line. Scene, size, camera, light and the
/// rest are those of `render`.
struct ExplainPixelArguments {
    RenderArguments render;
    std::string pixel;  ///< "X,Y"
    std::optional<std::string> output, objects;
    bool json = false;
};

/// The checked request.
struct ExplainRequest {
    RenderRequest render;
    PixelPlace pixel;
    std::optional<std::filesystem::path> output;
    size_t max_objects = 16;
    bool json = false;
};

/// Prints how one pixel is computed, and draws it. Returns the exit code.
int run_explain_pixel(const ExplainPixelArguments& arguments);

}  // namespace obscura::app
