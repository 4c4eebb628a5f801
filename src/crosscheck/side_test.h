// crosscheck/side_test.h - the sides on which a ray passes edges, with rounding bounds.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

namespace obscura::crosscheck {

/// A triangle and a ray in the triangle's own space, the ray's origin at zero. Embree's robust
/// test decides by the signs of the three sides.
struct SideTest {
    Vec3d corner[3];
    Vec3d direction;
    Vec3d room;  ///< how far a corner may be off along each axis

    const Vec3d& from(size_t k) const { return corner[k]; }
    const Vec3d& to(size_t k) const { return corner[(k + 1) % 3]; }

    /// On which side of edge k, as an infinite line, the ray passes: its distance from that line
    /// times the edge's length, the direction's and the sine of the angle between them, signed.
    double side(size_t k) const { return dot(direction, cross(from(k), to(k))); }
    double facing() const { return side(0) + side(1) + side(2); }

    /// Error bound of side(k) in single precision: the ends of the edge may move within their room,
    /// and dot(cross(to - from, to + from), direction), which is twice the side, is rounded. Each
    /// of its products has been rounded seven times at most: in two factors, as a product and in a
    /// difference for the cross product, as a product and in two sums for the scalar product. In
    /// addition, a 2^-23rd of the sum of all sides is allowed on the wrong side.
    ///
    /// Source  Higham, "Accuracy and Stability of Numerical Algorithms", 2nd ed., 2002, section
    ///         3.1; Embree's triangle_intersector_pluecker.h
    double rounding(size_t k) const;
};

/// In   item: a triangle; room_m: how far in the world a corner may be moved
SideTest side_test(const TrueScene& scene, const TrueRay& ray, const Item& item, double room_m);

}  // namespace obscura::crosscheck
