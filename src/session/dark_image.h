// session/dark_image.h - warns of finished images that are nearly black.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "image/write.h"
#include "session/render_request.h"

#include <optional>

namespace obscura {

/// Mean luminance over the pixels, each weighted by how far surfaces or an environment cover it.
///
/// In      image: with channels R, G, B, and maybe A, with which they are multiplied
/// Out     nothing where there are no such channels, or nothing is covered
/// Source  Rec. ITU-R BT.709-6, item 3.2 (the weights of the luminance)
std::optional<double> mean_luminance(const OutputImage& image);

/// Warns when an image that shows light has a mean luminance below one percent of the display's
/// white, and what it shows is dim, too: the warning says what lit the scene, and what would help.
///
/// In      scene: as it was rendered; exposure_ev: of the display, with that of the camera
void warn_of_dark_image(const OutputImage& image,
                        const RenderRequest& request,
                        const Scene& scene,
                        double exposure_ev,
                        Log& log);

}  // namespace obscura
