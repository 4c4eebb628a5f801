// session/smaller_image.cpp - the request of the same view with fewer pixels.
// SPDX-License-Identifier: Apache-2.0
#include "session/smaller_image.h"

#include <algorithm>

namespace obscura {

RenderRequest smaller_image(const RenderRequest& request, int factor, int samples_per_pixel) {
    RenderRequest out = request;
    RenderOptions& options = out.options;
    options.width = std::max(options.width / factor, 1);
    options.height = std::max(options.height / factor, 1);
    options.samples_per_pixel = samples_per_pixel;
    options.adaptive.reset();
    options.layers.clear();
    out.denoise = false;
    if (out.camera.focus_on_px) {
        auto& pixel = *out.camera.focus_on_px;
        pixel = {std::min(pixel[0] / factor, options.width - 1),
                 std::min(pixel[1] / factor, options.height - 1)};
    }
    return out;
}

}  // namespace obscura
