// crosscheck/tessellation.h - fine meshes of analytic shapes, by their definitions alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/shape_row.h"

#include <array>
#include <vector>

namespace obscura {

/// Triangles without common vertices where that is simpler: the same numbers all the same, so that
/// neighbours leave no gap.
struct ShapeMesh {
    std::vector<std::array<Vec3d, 3>> triangles;  ///< in the shape's space, metres; not oriented
    /// How far the mesh and the shape are apart at most; of quadrics twice what was found at the
    /// middles of triangles and edges.
    double error_m = 0;
};

/// Solids of revolution by their outline, boxes and planes by their corners, quadrics by the places
/// where the equation changes its sign on a grid. Vertices lie on the surface; src/shape's ways of
/// meeting rays are not used.
///
/// Out     no triangles: of planes without end, and of a quadric that a grid cannot show to a
///         thousandth of its size, such as one around the point of a cone
/// Source  quadrics: Doi and Koide, "An efficient method of triangulating equi-valued surfaces by
///         using tetrahedral cells", IEICE Transactions E74, 1991
ShapeMesh tessellate(const ShapeRow& row);

}  // namespace obscura
