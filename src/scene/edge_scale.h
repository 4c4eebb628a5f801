// scene/edge_scale.h - a scale that keeps products of edges in the range of single precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// A power of two by which shading multiplies triangle edges. The length of a normal is the square
/// root of a sum of fourth powers of edges: single precision holds them from 1e-9 to 4e9. The scale
/// is 1 unless the largest coordinate of the scene is above 1e6 or below 1e-3.
float edge_scale(const Scene& scene);

}  // namespace obscura
