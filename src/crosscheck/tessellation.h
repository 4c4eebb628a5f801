// crosscheck/tessellation.h - fine meshes of analytic shapes, by their definitions alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/shape_record.h"

#include <array>
#include <vector>

namespace obscura::crosscheck {

/// Triangles may repeat vertices: with the same numbers, so that neighbours leave no gap.
struct ShapeMesh {
    std::vector<std::array<Vec3d, 3>> triangles;  ///< in the shape's space, metres; not oriented
    /// Largest distance between mesh and shape; for quadrics, twice that measured at the centres of
    /// triangles and edges.
    double error_m = 0;
};

/// Solids of revolution from their outline, boxes and planes from their corners, quadrics from sign
/// changes of the equation on a grid. Vertices lie on the surface; no intersection formula of
/// src/shape is used.
///
/// Out     no triangles for infinite planes, and for a quadric that a grid does not resolve to a
///         thousandth of its size, such as one around the apex of a cone
/// Source  quadrics: Doi and Koide, "An efficient method of triangulating equi-valued surfaces by
///         using tetrahedral cells", IEICE Transactions E74, 1991
ShapeMesh tessellate(const ShapeRecord& record);

}  // namespace obscura::crosscheck
