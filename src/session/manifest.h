// session/manifest.h - a line of JSON for each image of a command: what was written, of what.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "session/camera_choice.h"
#include "session/image_list.h"
#include "session/render_request.h"

#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// What became of one image.
struct ImageOutcome {
    const ListedImage& image;
    View view;
    std::optional<ChosenCamera> camera = {};  ///< none: it was not rendered
    double seconds = 0;
    std::vector<std::string> warnings = {};
    std::optional<Error> error = {};
    bool was_there = false;  ///< --skip-existing left it as it was
};

/// The line, without its end; docs/many_images.md lists its members. Files are read for their
/// SHA-256.
///
/// In      request: of this image
std::string manifest_line(const RenderRequest& request, const ImageOutcome& outcome);

/// The file of --manifest: lines are there as soon as they are added.
class Manifest {
public:
    /// Makes its folder.
    ///
    /// In      anew: what is there is dropped; else lines are added to it, also while other
    ///         processes add theirs
    /// Errors  74 E-OUT-WRITE; 73 E-OUT-CREATE not a regular file
    static Result<Manifest> open(const std::filesystem::path& file, bool anew);

    /// Errors  74 E-OUT-WRITE
    Result<void> add(const std::string& line);

    Manifest(Manifest&& other) noexcept;
    Manifest& operator=(Manifest&&) = delete;
    ~Manifest();

private:
    Manifest(std::filesystem::path file, int descriptor);
    std::filesystem::path file_;
    int descriptor_;
};

}  // namespace obscura
