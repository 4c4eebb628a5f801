// serve/view_settings.h - what a client asks a picture for, and who makes a request of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json.h"
#include "session/render_request.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace obscura::serve {

/// Options of `obscura render`, by their names without dashes.
using Options = nlohmann::json;

/// The command line's own words for options: the server knows none of them but a few.
struct OptionReader {
    /// Checks the options and makes a request of them, without outputs.
    ///
    /// Errors  64 those of a command line; E-USAGE an option that pictures do not take
    std::function<Result<RenderRequest>(const std::filesystem::path& scene, const Options& options)>
        request;
    /// The command line that renders the same picture to a file.
    std::function<std::string(const std::string& scene, const Options& options)> command;
};

/// A picture that a client asks for.
struct Wish {
    int number = 0;
    RenderRequest request;
    std::string rendering;  ///< what its samples depend on: the same text, the same samples
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();

    /// Since it came.
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
    }
};

/// Options that change how finished samples are shown, and nothing else.
bool is_of_display(const std::string& option, const Options& all);

/// Wish::rendering of some options.
std::string rendering_of(const Options& options);

}  // namespace obscura::serve
