// session/library_image.h - a finished image becomes the library's Image, and one to be written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/outputs.h"

#include <obscura/image.h>

namespace obscura::v0 {

/// What a file needs to know of an image besides its pixels.
struct Image::Source {
    ImageMetadata metadata;
    obscura::Integrator integrator;
    std::optional<double> ev100;
};

}  // namespace obscura::v0

namespace obscura {

/// The image with its layers, for the caller to keep.
v0::Image library_image(const FinishedImage& finished,
                        const RenderRequest& request,
                        const ChosenCamera& camera);

/// The image to be written, as the caller may have changed it. Attributes that were left as they
/// were keep their types; the others are texts.
///
/// In      image: with a source
FinishedImage finished_image(const v0::Image& image);

}  // namespace obscura
