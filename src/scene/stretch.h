// scene/stretch.h - whether instances have scales that differ by direction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// Whether the transform of some instance, at some time, is more than a rotation, a reflection and
/// one scale: then normals change their lengths by different factors.
bool has_stretched_instances(const Scene& scene);

}  // namespace obscura
