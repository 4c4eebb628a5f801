// app/explain_pixel_command.h - the subcommand `obscura explain-pixel`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

#include "explain/explain_pixel.h"
#include <filesystem>
#include <optional>
#include <string>

namespace obscura {

/// The texts of the options as they stood on the command line. The scene, the picture's size, the
/// camera, the light and the rest are those of `render`.
struct ExplainPixelArguments {
    RenderArguments render;
    std::string pixel;  ///< "X,Y"
    std::optional<std::string> output, objects;
    bool json = false;
};

/// Everything that was asked for, checked.
struct ExplainRequest {
    RenderRequest render;
    PixelPlace pixel;
    std::optional<std::filesystem::path> output;
    size_t most_objects = 16;
    bool json = false;
};

/// Prints how one pixel comes about, and draws it. Returns the exit code.
int run_explain_pixel(const ExplainPixelArguments& arguments);

}  // namespace obscura
