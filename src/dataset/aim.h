// dataset/aim.h - chooses views from inside a scene that show something.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/asset_renderer.h"

namespace obscura::dataset {

/// Tries views from inside (CameraRequest::inside), one after the other, until one shows several
/// objects, nearly no background and nothing right before the camera; else takes the best of them.
/// Other views stay as they are.
///
/// In, out  request: of this image; becomes that of the chosen view
/// In       camera: of the first view
/// Errors   those of AssetRenderer::look_again
Result<ChosenCamera> aim(AssetRenderer& renderer,
                         RenderRequest& request,
                         const ChosenCamera& camera,
                         Log& log);

}  // namespace obscura::dataset
