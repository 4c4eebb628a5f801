// render/shape_light_table.h - lists emissive spheres, rectangles and disks for sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/shape_light.h"
#include "scene/scene.h"

#include <vector>

namespace obscura {

/// The emissive shapes that can be sampled: spheres that are round in the world, finite planes and
/// disks without a hole. Other emitters are left to BSDF sampling. Writes Primitive::light_base and
/// Instance::light_base; lights of shapes are numbered from `first` on.
std::vector<ShapeLight> collect_shape_lights(Scene& scene, int32_t first);

/// Power of a light, for choosing it: an upper bound if it has a texture.
double shape_light_power(const ShapeLight& light);

/// The maximum radiance of any emissive shape, sampled or not, with its texture taken as white.
double brightest_shape_radiance(const Scene& scene);

}  // namespace obscura
