// denoise/reprojection.h - a neighbouring frame, moved to where this one shows its surfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/frame.h"

namespace obscura {

/// The neighbour with each of its pixels where `input` shows the same surface, by the motion of
/// both. A pixel counts for nothing whose surface is out of sight there: beyond the image, or
/// behind something else, from where motion does not lead back.
Frame reproject(const DenoiseInput& input, const NeighborFrame& neighbor);

}  // namespace obscura
