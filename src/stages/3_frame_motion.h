// stages/3_frame_motion.h - stage 3 for the AOV `motion`: from frame to frame, in pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_surface.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The hits of one group, and the frames to compare.
struct FrameHits {
    const SceneView& scene;
    const BatchSettings& batch;
    const FrameView& frames;
    const HitLanes& hit;
    Mask hits;  ///< lanes to work out
};

/// Where the same points of the surfaces are seen one frame before (x, y) and one frame after
/// (z, w), minus where they are seen at the image's own time, whatever moves while its shutter is
/// open. Exactly 0 where neither the surface nor the camera moves, and where one of the two
/// positions cannot be projected (camera/project.h).
///
/// In      position: of the hits, in the world
/// Units   pixels of the whole image; x to the right, y down
/// Errors  none: a panorama's image has no seam, so that the shorter way round counts; from face to
///         face of a cube map the difference is that of the positions in the image
Four<Lanes> frame_motion(const FrameHits& at, const Vec3<Lanes>& position);

}  // namespace OBSCURA_ISA
}  // namespace obscura
