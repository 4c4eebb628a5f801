// accel/moving_geometry.h - hands moving vertices and transforms to Embree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/embree.h"
#include "scene/scene.h"

namespace obscura {

/// Sets vertices and indices of moving triangles, a vertex buffer for each time.
void set_moving_triangles(const Scene& scene, const Primitive& primitive, RTCGeometry geometry);

/// Sets the transform of an instance, one for each time where it moves.
void set_instance_transforms(const Scene& scene, const Instance& instance, RTCGeometry geometry);

}  // namespace obscura
