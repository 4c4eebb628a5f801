// serve/drake_image.h - makes the images that Drake's render client asks for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/drake.h"
#include "serve/scene_cache.h"
#include <atomic>
#include <cstddef>
#include <vector>

namespace obscura::serve {

/// An image of one request.
struct DrakeJob {
    const DrakeRequest& wanted;
    LabelEncoding labels = LabelEncoding::color;
    const RenderRequest& request;   ///< without what apply() adds
    const std::atomic<bool>& stop;  ///< true: nobody waits for it any more
};

/// Makes the image as a file: colours as PNG, depth in metres along the view axis as TIFF of 32-bit
/// floats, labels as PNG. Depth and labels are those of the middle of each pixel, so that none is a
/// mixture. Waits while another request uses the scene. Exceptions become errors.
///
/// Errors  65 E-DRAKE-CAMERA the scene has no camera; those of OpenAsset, of rendering and encoding
Result<std::vector<std::byte>> make_drake_image(SentScene& scene, const DrakeJob& job);

}  // namespace obscura::serve
