// render/camera_media.h - finds the media that a camera is inside of, by counting crossings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"

#include <cstdint>

namespace obscura {

/// Numbers of up to three media around a point, in the format of BatchSettings::medium_stack.
///
/// A point is inside a medium if a ray from it crosses the boundary an odd number of times. The
/// majority of three directions decides, in case one ray runs along an edge. Boundaries must be
/// closed.
uint32_t medium_stack_around(const Accel& accel, const Scene& scene, const Vec3f& point);

}  // namespace obscura
