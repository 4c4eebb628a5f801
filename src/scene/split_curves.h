// scene/split_curves.h - gives lines a point of their own where they pass a surface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <functional>

namespace obscura {

/// Splits every piece of a line whose ends lie on different sides, where `side` is 0. Colours are
/// interpolated; the new points' radii are for the caller to set.
///
/// In   side: linear along every line
void split_curves(Scene& scene, const std::function<double(const Vec3d& place_m)>& side);

}  // namespace obscura
