// render/shape_light_table.h - emissive spheres, rectangles and disks as rows of the light table.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/shape_light.h"
#include "scene/scene.h"

#include <vector>

namespace obscura {

/// The emissive shapes that can be sampled: spheres that are round in the world, finite planes and
/// disks without a hole. What else glows is left to the rays that meet it. Writes
/// Primitive::light_base and Instance::light_base; lights of shapes are numbered from `first` on.
std::vector<ShapeLight> collect_shape_lights(Scene& scene, int32_t first);

/// Watts per steradian unit of radiance that a light sends out, for choosing it: an upper bound
/// where it has a texture.
double shape_light_power(const ShapeLight& light);

/// The largest radiance of any emissive shape, sampled or not, its texture taken as white.
double brightest_shape_radiance(const Scene& scene);

}  // namespace obscura
