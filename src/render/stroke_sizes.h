// render/stroke_sizes.h - points and lines as thick as asked for, in metres or in pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"
#include "scene/scene.h"

namespace obscura {

enum class LengthUnit { metres, pixels };

/// How thick points or lines are.
struct StrokeSize {
    double diameter = 0;
    LengthUnit unit = LengthUnit::metres;
};

struct StrokeSizes {
    StrokeSize points = {3, LengthUnit::pixels};
    StrokeSize lines = {2, LengthUnit::pixels};
};

/// True for a scene with points or lines.
bool has_strokes(const Scene& scene);

/// How much of the world one pixel covers at a place, across the view, in metres. The picture's
/// size is the one that the camera was made for.
///
/// Out     flat films: by depth along the view axis; round ones: by distance and the angle of the
///         pixel in the middle. What lies behind a flat film counts as in front of it.
double pixel_size_m(const Camera& camera, const Vec3d& place_m);

/// Gives points and lines their radii, those in pixels as this camera sees them. A line that passes
/// a flat film's eye gets a point of its own there: else it would not get thin towards the eye.
///
/// In   camera: not looked at where both sizes are in metres
void size_strokes(const StrokeSizes& sizes, const Camera& camera, Scene& scene);

}  // namespace obscura
