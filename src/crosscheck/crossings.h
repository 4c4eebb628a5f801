// crosscheck/crossings.h - where a line crosses a shape, by signs alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "shape/shape_row.h"
#include "shape/triangle.h"

namespace obscura {

/// Where a line goes into something and comes out of it, wherever the ray begins; where it only
/// touches both are one place. One number where there is no other side.
struct Crossings {
    int count = 0;
    double t[2] = {0, 0};

    void add(double place) { t[count++] = place; }
};

/// No equation is solved here, and no formula is src/shape's: of a solid shape the line's deepest
/// place is searched for, for the side (shape_side.h) is convex along the line, and from there the
/// two places where it changes its sign. A quadric's side is looked at where it is least or
/// greatest and at the ends of the part in the box: between these it changes its sign once or not
/// at all. A line in a surface does not cross it. What is within a few roundings in double of
/// touching touches; a quadric, of which single precision holds the coefficients, of those.
Crossings cross_shape(const ShapeRow& row, const TrueRay& line);

/// Likewise for the hull of two balls.
Crossings cross_hull(const Vec3d (&middle)[2], const double (&radius)[2], const TrueRay& line);

/// By the signs of three volumes, one between the line and each edge: neighbours see the same
/// number with the other sign, so that no line goes between them. A line on an edge or through a
/// corner meets the triangle; one in its plane does not.
///
/// Source  Plücker; Shoemake, "Plücker coordinate tutorial", Ray Tracing News 11(1), 1998
Crossings cross_triangle(const Triangle<double>& triangle, const TrueRay& line);

}  // namespace obscura
