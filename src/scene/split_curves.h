// scene/split_curves.h - splits curve segments that cross a surface or are very long.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <functional>

namespace obscura {

/// Splits every curve segment whose ends have different signs of `side`, at its zero. Colours and
/// normals are interpolated; the caller sets the new points' radii.
///
/// In   side: linear along every curve
void split_curves(Scene& scene, const std::function<double(const Vec3d& position_m)>& side);

/// Splits segments that are much longer than thick into equal ones, at most 64: Embree's precision
/// is relative to a segment's length, so that thin ones get holes. Colours and radii are
/// interpolated.
void split_long_curves(Scene& scene);

}  // namespace obscura
