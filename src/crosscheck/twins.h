// crosscheck/twins.h - analytic shapes beside fine meshes of the same form.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "crosscheck/kernels.h"
#include "crosscheck/tessellation.h"

#include <optional>

namespace obscura {

struct TwinReport {
    size_t shapes = 0;   ///< that were compared, each in its own space
    size_t skipped = 0;  ///< that have no twin (see tessellate), or came after most_twins others
    size_t triangles = 0;
    /// Of all together; the ulp is a quarter of how far mesh and shape may be apart. Empty: no
    /// shape was compared.
    std::optional<PairFigures> figures;
};

inline constexpr size_t most_twins = 32;

/// What Embree finds on a mesh against what our user geometry finds on a shape.
///
/// In      rays: how many; embree_isa: of the renderer's queries, "": widest
/// Errors  those of Accel::build
Result<PairFigures> compare_with_mesh(const ShapeRow& row,
                                      const ShapeMesh& mesh,
                                      uint64_t rays,
                                      const std::string& embree_isa);

/// Compares the shapes of a scene with their meshes, equal shapes once.
///
/// In      rays: in all
/// Errors  those of Accel::build
Result<TwinReport> check_twins(const Scene& scene, uint64_t rays, const std::string& embree_isa);

}  // namespace obscura
