// explain/workings.h - the lecture's formulas for one ray and one object, worked out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "explain/term.h"
#include "shape/shape_record.h"
#include "shape/triangle.h"

namespace obscura {

/// A formula with its numbers. Only the records of src/shape are used: these are the textbook's
/// formulas in double precision, as one would work them out by hand.
struct Working {
    std::string equation;  ///< what is solved
    std::vector<Term> terms;
    std::vector<double> t;  ///< where the line meets the object, in order; hits behind the eye, too
    std::string missed;     ///< why there is none; empty where there are some
    /// Triangles: how far outside (below 0: inside) the line passes, in barycentric coordinates.
    double outside = 0;
};

/// Source  Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of
///         Graphics Tools 2(1), 1997
Working work_out_triangle(const Triangle<double>& triangle, const crosscheck::TrueRay& ray);

/// In      ray: in the shape's own space
/// Source  Glassner (ed.), "An Introduction to Ray Tracing", 1989, ch. 2 and 3
Working work_out_shape(const ShapeRecord& record, const crosscheck::TrueRay& ray);

}  // namespace obscura
