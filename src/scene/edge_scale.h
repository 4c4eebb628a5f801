// scene/edge_scale.h - the unit in which edges of tiny and huge scenes are multiplied.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// A power of two. A normal's length is the square root of a sum of fourth powers of edges: in
/// single precision they fit from 1e-9 to 4e9. Where the scene's coordinates reach further than
/// 1e6, or nowhere as far as 1e-3, edges times this lie well within; else it is 1.
float edge_scale(const Scene& scene);

}  // namespace obscura
