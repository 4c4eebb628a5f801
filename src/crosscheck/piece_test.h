// crosscheck/piece_test.h - how Embree meets a piece of a line, and what rounding makes of that.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "shape/segment.h"

namespace obscura {

/// A number, and the most by which single precision may miss it.
struct RoundedNumber {
    double value = 0;
    double error = 0;
};

/// A ray and a piece: a cone that touches a ball at either end. Embree moves the ray's origin to
/// the place nearest to the piece's middle, there called o, and solves, with p from the first end
/// to the second, l = p . p, dr the difference of the radii and g = l - dr^2,
///
///     F(t) = g |x|^2 - (x . p)^2 - r0^2 l - 2 r0 dr (x . p) = a t^2 + 2 b t + c,   x = o + t d
///
/// for the cone, which lies where 0 <= x . p + r0 dr <= g. A ball of radius r at the second end
/// takes over from there; before the cone there is a ball of the piece's own only where no piece
/// ends. The ends, the radii and o are taken as moved by what p, o and dr have
/// been rounded; every other number is off by at most its products' sizes times how often one of
/// them has been rounded, half an ulp each time.
///
/// Source  Embree's roundline_intersector.h; Han, Wald, Usher, Wu, Wang, Pascucci, Hansen, Johnson,
///         "Ray Tracing Generalized Tube Primitives", 2019; Higham, "Accuracy and Stability of
///         Numerical Algorithms", 2nd ed., 2002, section 3.1
class PieceTest {
public:
    /// In   piece: as Embree has it; ray: t is along its direction from its own origin
    PieceTest(const Segment<double>& piece, const TrueRay& ray);

    /// True when rounding alone decides whether the ray's line meets the endless cone, or whether
    /// it runs along the cone: where one of them says no, Embree misses the piece with its ball.
    bool is_chance() const;

    /// How far from the true surface a hit at t may be found, or an edge of what is seen: metres.
    double surface_m(double t) const;

    /// True when the place at t is where cone and ball touch, as far as rounding tells them apart:
    /// each may take the hit for the other's.
    bool is_at_seam(double t) const;

    /// True when the place at t lies before the cone, on the ball at the first end.
    bool is_on_first_ball(double t) const;

    RoundedNumber a() const { return a_; }
    RoundedNumber b() const { return b_; }
    RoundedNumber c() const { return c_; }
    RoundedNumber discriminant() const { return discriminant_; }

private:
    /// F at t is off by at most this, solving included.
    double cone_error(double t) const;
    double ball_m() const;

    double radius_from_, radius_to_;
    double length_m_, cone_;     ///< cone_: g
    double cone_size_;           ///< of g: sum of the sizes of its products
    double start_;               ///< t of o
    double place_, place_size_;  ///< x . p + r0 dr at o
    double speed_, speed_size_;  ///< d . p
    double ball_near_;           ///< o less the second end, squared
    double ball_along_;          ///< sizes of its product with d
    double ball_on_way_;         ///< that product
    double direction2_;
    RoundedNumber a_, b_, c_, discriminant_;
};

}  // namespace obscura
