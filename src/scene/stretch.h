// scene/stretch.h - whether instances have scales that differ by direction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// Whether the transform of some instance, or one that it moves between, is more than a rotation,
/// a reflection and one scale: then normals change their lengths by different factors. What turns
/// is not counted for the little that it is squeezed between two transforms.
bool has_stretched_instances(const Scene& scene);

}  // namespace obscura
