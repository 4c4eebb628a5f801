// camera/project.h - where on the film a place in the world is seen: the inverse of generate_ray.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <optional>

namespace obscura {

/// The film point of a place in the world, (0,0) top left; through the middle of the lens. Nothing
/// where the camera cannot see it: behind a flat film, outside a fisheye's circle or a cylinder's
/// height, beyond a distortion's limit. With two eyes the left one counts.
std::optional<Vec2<double>> project(const Camera& camera, const Vec3d& place_world);

}  // namespace obscura
