// app/serve_request.h - the request of `obscura serve` and `obscura view`, checked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

#include "serve/server.h"
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line.
struct ServeArguments {
    std::string file;  ///< of `obscura view`: opened at once
    std::vector<std::string> roots;
    OptionText listen, port, token, max_upload, jobs, jobs_at_once;
    bool no_token = false;
    bool no_browser = false;
    RenderArguments render;  ///< options that all pictures get
};

struct ServeRequest {
    serve::ServerOptions server;
    std::optional<MemorySize> max_upload;
    std::string file;  ///< below the first root: opened at once; empty: none
    bool opens_browser = false;
    RenderArguments render;
};

/// Chooses the roots and a token, and says how options of pictures are read.
///
/// Errors  64 E-USAGE-RANGE, E-USAGE-NUMBER, E-USAGE-CONFLICT beyond this machine without a token;
///         66 E-SCENE-MISSING, 73 E-SERVE-ROOT a root is no folder
Result<ServeRequest> make_serve_request(const ServeArguments& arguments);

/// How pictures of a server are asked for: by options of `obscura render` that change what is
/// seen; none names a file but the scene and --env.
serve::OptionReader image_options(const RenderArguments& common,
                                  const std::vector<std::filesystem::path>& roots = {});

}  // namespace obscura::app
