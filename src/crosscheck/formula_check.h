// crosscheck/formula_check.h - the formulas in double against what a point's own place says.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

#include <cstdint>

namespace obscura {

/// Which side of a shape a point lies on, by the shape's definition alone: below 0 inside, or
/// behind a flat or open one. Nothing of src/shape is used but the row's numbers.
double side_of_shape(const ShapeRow& row, const Vec3d& point);

struct FormulaCheck {
    uint64_t segments = 0;
    uint64_t wrong = 0;
};

/// Takes two random points near random items: a segment between them must meet a shape an odd
/// number of times when its ends lie on different sides, and a triangle when it goes through a
/// place inside of it. This is what the truth itself rests on: a wrong formula of src/shape, in
/// double as in single precision, ends here.
FormulaCheck check_formulas(const TrueScene& scene, uint64_t segments, uint64_t seed);

}  // namespace obscura
