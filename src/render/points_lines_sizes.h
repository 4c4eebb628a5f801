// render/points_lines_sizes.h - sets the thickness of points and lines, in metres or in pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"
#include "scene/scene.h"

namespace obscura {

enum class LengthUnit { metres, pixels };

/// Thickness of points or lines.
struct PointsLinesSize {
    double diameter = 0;
    LengthUnit unit = LengthUnit::metres;
};

struct PointsLinesSizes {
    PointsLinesSize points = {3, LengthUnit::pixels};
    PointsLinesSize lines = {2, LengthUnit::pixels};
};

/// True for a scene with points or lines.
bool has_points_lines(const Scene& scene);

/// Size of one pixel at a position in the world, across the view, in metres. The image size is the
/// one that the camera was made for.
///
/// Out     flat films: by depth along the view axis; round ones: by distance and the angle of the
///         centre pixel. Positions behind a flat film count as in front of it.
double pixel_size_m(const Camera& camera, const Vec3d& position_m);

/// Sets the radii of points and lines; sizes in pixels hold for this camera. A line that passes the
/// plane of a flat film's eye is split there: else it would not get thinner towards the eye.
///
/// In   camera: unused if both sizes are in metres
void size_points_lines(const PointsLinesSizes& sizes, const Camera& camera, Scene& scene);

}  // namespace obscura
