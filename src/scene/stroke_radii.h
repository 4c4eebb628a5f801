// scene/stroke_radii.h - how thick a scene's points and lines are.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <functional>

namespace obscura {

/// Radius in metres, more than 0, of something at a place in the world.
using RadiusAt = std::function<double(const Vec3d& place_m)>;

/// Sets the radius of every point and of both ends of every piece of a line (see is_point_or_line);
/// all else keeps its own.
void set_stroke_radii(Scene& scene, const RadiusAt& of_points, const RadiusAt& of_lines);

/// The size that they have until a camera is known: a five-hundredth of the scene's diagonal
/// across.
void set_default_stroke_radii(Scene& scene);

}  // namespace obscura
