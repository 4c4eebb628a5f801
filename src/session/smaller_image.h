// session/smaller_image.h - the request of the same view with fewer pixels, for quick looks at it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura {

/// The same view with so many times fewer pixels on each side, without layers, with a fixed number
/// of samples.
RenderRequest smaller_image(const RenderRequest& request, int factor, int samples_per_pixel);

}  // namespace obscura
