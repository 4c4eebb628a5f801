// app/listed_images.h - the images of a command: their numbers, files and failures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_job.h"

#include <vector>

namespace obscura::app {

/// The indices of the images that this command renders.
std::vector<size_t> indices_to_render(const RenderRequest& request, size_t count);

/// No two renderings of a job may write one file.
///
/// Errors  64 E-USAGE-SAMEFILE
Result<void> note_files(Job& job, const std::vector<ListedImage>& images);

/// Failures of images of a list, which do not end the rest.
class ImageFailures {
public:
    /// Tells of one and keeps it for the end.
    void add(const ListedImage& image, const Error& error, Log& log);

    size_t count() const { return errors_.size(); }

    /// The first one, with the others; there must be one.
    ///
    /// In   asked: images that were to be made
    Error all(size_t asked) &&;

private:
    std::vector<Error> errors_;
};

}  // namespace obscura::app
