// accel/splat_layers.h - the Gaussian splats that a ray passes: found by Embree, blended in order.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "shape/shape_row.h"

#include <cstdint>

namespace obscura {

/// A splat that a ray passes.
struct SplatLayer {
    float t, alpha;
    int32_t row;  ///< in SplatField
};

/// Less than this of the light behind goes on through splats: then it is none.
/// Source  Kerbl et al. 2023, appendix C
inline constexpr float least_transmittance = 1e-4f;

/// The layers of one ray in no order, with room for at least splat_block more.
struct SplatList {
    SplatLayer* layers = nullptr;
    int count = 0;
    int capacity = 0;
};

/// Makes room for splat_block more layers: drops those that no light from behind passes, or takes
/// more memory.
///
/// In   end: of the ray. Returns its new end: further away there is nothing to be seen
float make_room(SplatList& list, float end);

/// What the user geometry of all splats knows; a block is an Embree primitive.
struct SplatGeometry {
    const float* blocks = nullptr;
    const ShapeBox* boxes = nullptr;
};

/// A query for splats. The common part must come first.
struct SplatContext {
    QueryContext common;
    SplatList* list = nullptr;
};

/// The callbacks of one instruction set. They list what a ray passes and never report a hit.
struct SplatCallbacks {
    RTCBoundsFunction bounds;
    RTCIntersectFunctionN intersect;
};

}  // namespace obscura
