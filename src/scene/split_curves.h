// scene/split_curves.h - more points for lines that pass a surface or are long.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <functional>

namespace obscura {

/// Splits every piece of a line whose ends lie on different sides, where `side` is 0. Colours and
/// normals are interpolated; the new points' radii are for the caller to set.
///
/// In   side: linear along every line
void split_curves(Scene& scene, const std::function<double(const Vec3d& place_m)>& side);

/// Splits pieces that are much longer than thick into equal ones, at most 64: Embree finds the way
/// through a piece relative to its length, so that a thin one gets holes. Colours and radii are
/// interpolated.
void split_long_curves(Scene& scene);

}  // namespace obscura
