// camera/project.h - projects a world position to the film: the inverse of generate_ray.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <optional>

namespace obscura {

/// The film point of a world position, (0,0) top left, through the centre of the lens. Nothing if
/// the camera cannot see it: behind a flat film, outside a fisheye's circle or a cylinder's height,
/// or past the limit of the distortion. With two eyes the left one counts.
std::optional<Vec2<double>> project(const Camera& camera, const Vec3d& position_world);

/// The same for a position in camera space.
std::optional<Vec2<double>> project_local(const Camera& camera, const Vec3d& position_camera);

}  // namespace obscura
