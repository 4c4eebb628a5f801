// crosscheck/closed_components.h - finds closed meshes and solid shapes; each becomes a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <vector>

namespace obscura::crosscheck {

/// A connected mesh without border, or one solid shape, where it first appears in the scene.
struct ClosedComponent {
    Scene scene;
    size_t items = 0;  ///< triangles; 1 for a shape
};

struct ClosedComponents {
    std::vector<ClosedComponent> components;  ///< the largest ones, in descending order
    size_t found = 0;                         ///< number of all of them
};

/// Corners with equal coordinates are one. A mesh is closed when along every edge as many triangles
/// run one way as the other.
///
/// In   most: how many components to keep
ClosedComponents find_closed_components(const Scene& scene, size_t most);

}  // namespace obscura::crosscheck
