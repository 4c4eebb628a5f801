// crosscheck/segment_rounding.h - Embree's test of a curve segment, and bounds of its rounding.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "shape/segment.h"

namespace obscura::crosscheck {

/// A number, and a bound of its error in single precision.
struct RoundedNumber {
    double value = 0;
    double error = 0;
};

/// A ray and a segment: a cone that touches a sphere at either end. Embree moves the ray's origin
/// to the point closest to the segment's centre, here called o, and solves, with p from the first
/// end to the second, l = p . p, dr the difference of the radii and g = l - dr^2,
///
///     F(t) = g |x|^2 - (x . p)^2 - r0^2 l - 2 r0 dr (x . p) = a t^2 + 2 b t + c,   x = o + t d
///
/// for the cone, which lies where 0 <= x . p + r0 dr <= g. Beyond it the end cap, a sphere of
/// radius r, takes over at the second end; the first end has a cap of its own only where no segment
/// ends. The ends, the radii and o count as moved by the rounding of p, o and dr; every other
/// number is off by at most its products' sizes times how often one of them has been rounded, half
/// an ulp each time.
///
/// Source  Embree's roundline_intersector.h; Han, Wald, Usher, Wu, Wang, Pascucci, Hansen, Johnson,
///         "Ray Tracing Generalized Tube Primitives", 2019; Higham, "Accuracy and Stability of
///         Numerical Algorithms", 2nd ed., 2002, section 3.1
class SegmentRounding {
public:
    /// In   segment: as Embree has it; ray: its t counts along its direction from its own origin
    SegmentRounding(const Segment<double>& segment, const TrueRay& ray);

    /// True when rounding alone decides whether the ray's line meets the infinite cone, or whether
    /// it runs along the cone: in either case Embree may miss the segment with its end cap.
    bool is_chance() const;

    /// Distance from the true surface at which a hit at t, or an edge, may be found: metres.
    double surface_m(double t) const;

    /// True when cone and end cap touch at t, within rounding: each may take the other's hit.
    bool is_at_seam(double t) const;

    /// True when the point at t lies before the cone, on the cap at the first end.
    bool is_on_first_cap(double t) const;

    RoundedNumber a() const { return a_; }
    RoundedNumber b() const { return b_; }
    RoundedNumber c() const { return c_; }
    RoundedNumber discriminant() const { return discriminant_; }

private:
    /// Error bound of F at t, solving included.
    double cone_error(double t) const;
    double cap_m() const;

    double radius_from_, radius_to_;
    double length_m_, cone_;     ///< cone_: g
    double cone_size_;           ///< of g: sum of the sizes of its products
    double start_;               ///< t of o
    double place_, place_size_;  ///< x . p + r0 dr at o
    double speed_, speed_size_;  ///< d . p
    double cap_near_;            ///< o less the second end, squared
    double cap_along_;           ///< sizes of its product with d
    double cap_on_way_;          ///< that product
    double direction2_;
    RoundedNumber a_, b_, c_, discriminant_;
};

}  // namespace obscura::crosscheck
