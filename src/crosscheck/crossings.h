// crosscheck/crossings.h - where a line crosses a shape, found by signs alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "shape/shape_record.h"
#include "shape/triangle.h"

namespace obscura::crosscheck {

/// Where a line enters and leaves an object, wherever the ray begins; where it only touches, both
/// are one position. One number where there is no other side.
struct Crossings {
    int count = 0;
    double t[2] = {0, 0};

    void add(double place) { t[count++] = place; }
};

/// No equation is solved here, and no formula is src/shape's. A solid shape's side (shape_side.h)
/// is convex along the line: from its minimum, both sign changes are searched for. A
/// quadric's side is sampled at its extremum and at the ends of the range in the box: between these
/// it changes its sign at most once. A line in a surface does not cross it. A distance within a few
/// roundings in double counts as touching; for a quadric, a few roundings of its single precision
/// coefficients.
Crossings cross_shape(const ShapeRecord& record, const TrueRay& line);

/// The same for the hull of two spheres.
Crossings cross_hull(const Vec3d (&middle)[2], const double (&radius)[2], const TrueRay& line);

/// By the signs of three volumes, one between the line and each edge: neighbours compute the same
/// number with the opposite sign, so that no line passes between them. A line on an edge or through
/// a corner meets the triangle; one in its plane does not.
///
/// Source  Plücker; Shoemake, "Plücker coordinate tutorial", Ray Tracing News 11(1), 1998
Crossings cross_triangle(const Triangle<double>& triangle, const TrueRay& line);

}  // namespace obscura::crosscheck
