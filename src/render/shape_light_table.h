// render/shape_light_table.h - lists emissive spheres, rectangles and disks for sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/light_table.h"

namespace obscura {

/// The emissive shapes that can be sampled: spheres that are round in the world, finite planes and
/// disks without a hole. Other emitters are left to BSDF sampling, and so are double-sided spheres
/// with alpha: light sampling knows their near side only, and their far side shines through it.
/// Writes Primitive::light_base and Instance::light_base.
///
/// In/Out  table: with all its triangles; the shapes and their alpha are added
void collect_shape_lights(Scene& scene, LightTable& table);

/// Power of a light, for choosing it: an upper bound if it has a texture.
double shape_light_power(const LightTable& table, const ShapeLight& light);

/// The maximum radiance of any emissive shape, sampled or not, with its texture taken as white.
double brightest_shape_radiance(const Scene& scene);

}  // namespace obscura
