// crosscheck/twins.h - compares analytic shapes with fine meshes of the same form.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "crosscheck/kernels.h"
#include "crosscheck/tessellation.h"

#include <optional>

namespace obscura::crosscheck {

struct TwinReport {
    size_t shapes = 0;   ///< compared shapes, each in its own space
    size_t skipped = 0;  ///< that have no twin (see tessellate), or came after max_twins others
    size_t triangles = 0;
    /// All shapes together; the ulp is a quarter of the largest distance between mesh and shape.
    /// Empty: no shape was compared.
    std::optional<PairFigures> figures;
};

inline constexpr size_t max_twins = 32;

/// Compares Embree's hits on a mesh with those of our user geometry on the shape.
///
/// In      rays: how many; embree_isa: of the renderer's queries, "": widest
/// Errors  those of Accel::build
Result<PairFigures> compare_with_mesh(const ShapeRecord& record,
                                      const ShapeMesh& mesh,
                                      uint64_t rays,
                                      const std::string& embree_isa);

/// Compares the shapes of a scene with their meshes, equal shapes once.
///
/// In      rays: in all
/// Errors  those of Accel::build
Result<TwinReport> check_twins(const Scene& scene, uint64_t rays, const std::string& embree_isa);

}  // namespace obscura::crosscheck
