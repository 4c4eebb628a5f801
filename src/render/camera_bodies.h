// render/camera_bodies.h - the bodies with a volume that a camera is inside of.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"

#include <cstdint>

namespace obscura {

/// Numbers of up to three bodies around a point, as BatchSettings::bodies holds them.
///
/// A body is around the point when rays leave its boundary an odd number of times: by the majority
/// of three directions, so that no ray along an edge decides. Boundaries must be closed.
uint32_t bodies_around(const Accel& accel, const Scene& scene, const Vec3f& point);

}  // namespace obscura
