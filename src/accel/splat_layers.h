// accel/splat_layers.h - finds the Gaussian splats along a ray and blends them in order.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "shape/shape_record.h"

#include <cstdint>

namespace obscura {

/// A splat that a ray passes.
struct SplatLayer {
    float t, alpha;
    int32_t index;  ///< in SplatField
};

/// Splats with a total transmittance below this count as opaque.
/// Source  Kerbl et al. 2023, appendix C
inline constexpr float min_transmittance = 1e-4f;

/// The layers of one ray, unordered, with room for at least splat_block more.
struct SplatList {
    SplatLayer* layers = nullptr;
    int count = 0;
    int capacity = 0;
};

/// Makes room for splat_block more layers: drops those behind opaque layers, or allocates memory.
///
/// In   end: of the ray. Returns its new end: layers further away are invisible
float make_room(SplatList& list, float end);

/// User pointer of the geometry of all splats; each block is an Embree primitive.
struct SplatGeometry {
    const float* blocks = nullptr;
    const ShapeBox* boxes = nullptr;
};

/// Context of a query for splats. `common` must come first.
struct SplatContext {
    QueryContext common;
    SplatList* list = nullptr;
};

/// The callbacks of one instruction set. They list the splats along a ray and never report a hit.
struct SplatCallbacks {
    RTCBoundsFunction bounds;
    RTCIntersectFunctionN intersect;
};

}  // namespace obscura
