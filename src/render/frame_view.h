// render/frame_view.h - the scene and the camera of neighbouring frames, for the layer `motion`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/stages.h"

#include <optional>

namespace obscura {

/// The frames around an image's time as stages read them; nothing if no motion vectors are wanted,
/// or if they are all 0.
///
/// In      camera: of the image, where options.frame_cameras has none
std::optional<FrameView> frame_view(const Scene& scene,
                                    const Camera& camera,
                                    const RenderOptions& options);

}  // namespace obscura
