// crosscheck/formula_check.h - tests intersection formulas in double by signs at points.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

#include <cstdint>
#include <functional>

namespace obscura::crosscheck {

/// A set of intersection formulas.
struct CrossingFormulas {
    std::function<Crossings(const ShapeRecord&, const TrueRay&)> shape;
    std::function<Crossings(const Triangle<double>&, const TrueRay&)> triangle;
};

/// src/shape's formulas with F = double: those that the renderer has in single precision.
CrossingFormulas formulas_in_double();

/// The formulas of crossings.h: the truth.
CrossingFormulas true_crossings();

struct FormulaCheck {
    uint64_t segments = 0;
    uint64_t wrong = 0;        ///< of the formulas
    uint64_t wrong_truth = 0;  ///< of the truth

    bool operator==(const FormulaCheck&) const = default;
};

/// Takes two points near random items, every second time on a line along an axis, a ruling, an edge
/// or a surface (special_lines.h). A segment between them must meet a shape an odd number of times
/// when its ends lie on different sides (shape_side.h), else an even number, and a triangle exactly
/// when and where it passes through a point inside of it.
FormulaCheck check_formulas(const TrueScene& scene,
                            uint64_t segments,
                            uint64_t seed,
                            const CrossingFormulas& formulas = formulas_in_double());

}  // namespace obscura::crosscheck
