// crosscheck/closed_parts.h - the parts of a scene that have an inside, each as a scene of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <vector>

namespace obscura {

/// A connected mesh without border, or one solid shape, placed as where it first appears.
struct ClosedPart {
    Scene scene;
    size_t items = 0;  ///< triangles; 1 for a shape
};

struct ClosedParts {
    std::vector<ClosedPart> parts;  ///< the largest ones, largest first
    size_t found = 0;               ///< all of them
};

/// Corners count as one where all three coordinates are equal. A mesh is closed when along every
/// edge as many triangles run one way as the other.
///
/// In   most: how many parts to keep
ClosedParts find_closed_parts(const Scene& scene, size_t most);

}  // namespace obscura
