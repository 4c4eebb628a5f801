// serve/shown_image.h - what a client sees: codes for a display, and how far they have come.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/outputs.h"

#include <optional>

namespace obscura::serve {

/// One picture of a wish; the next one has less noise.
struct ShownImage {
    int serial = 0;  ///< counts the pictures of a viewer
    int wish = 0;
    DisplayedImage image;
    int samples = 0;  ///< of every pixel, at least
    int of = 0;       ///< those of the finished picture
    bool is_done = false;
    bool is_denoised = false;
    double seconds = 0;               ///< since the wish came
    std::optional<Error> error = {};  ///< in place of an image
};

/// The header X-Obscura-Image.
std::string image_header(const ShownImage& picture);

}  // namespace obscura::serve
