// scene/points_lines_radii.h - sets the radii of points and lines.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <functional>

namespace obscura {

/// Radius in metres, above 0, of a point or line at a position in the world.
using RadiusAt = std::function<double(const Vec3d& position_m)>;

/// Sets the radius of every point and of both ends of every curve segment that is a glTF point or
/// line (is_point_or_line); other shapes keep theirs.
void set_points_lines_radii(Scene& scene, const RadiusAt& of_points, const RadiusAt& of_lines);

/// Sets the default size until a camera is known: a diameter of 1/500 of the scene's diagonal.
void set_default_points_lines_radii(Scene& scene);

}  // namespace obscura
