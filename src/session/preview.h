// session/preview.h - 8-bit previews of AOVs, readable without a colour transform.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/write.h"
#include "render/render.h"

namespace obscura {

/// True for integrators whose values a display transform would spoil: all but path, direct and
/// raycast.
bool needs_preview(Integrator integrator);

/// Code values in [0, 1], three channels, for PNG and JPEG:
///  normal  0.5 n + 0.5; where nothing is, black
///  depth, distance  nearest white to farthest dark grey; where nothing is, black
///  uv      the fractional part of u as red, of v as green
///  id      a colour drawn from all numbers of the pixel; where nothing is, black
///  heat    black, red, yellow to white for what one pixel in a hundred exceeds
///  albedo, ao, facing, wireframe  encoded by the sRGB curve, without tone mapping; grey but for
///          albedo
///
/// In      image: as the integrator computes it, with or without a channel "A"
OutputImage preview_image(const OutputImage& image, Integrator integrator);

}  // namespace obscura
