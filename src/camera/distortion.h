// camera/distortion.h - lens distortion of perspective images by OpenCV's model, and its inverse.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera_ray.h"

namespace obscura {

/// Coefficients on the plane at distance 1, with OpenCV's axes: x to the right, y DOWN.
struct Distortion {
    float k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
    /// Largest undistorted radius that the model can undo; see largest_radius in the .cpp.
    float radius_limit = 0;  ///< 0: there is no distortion at all
};

/// The radius at which the radial polynomial stops growing and the image would fold over;
/// `far_away` if it grows for ever.
double largest_radius(double k1, double k2, double k3, double far_away);

inline namespace OBSCURA_ISA {

/// A distorted point and its derivatives by the undistorted one.
template <typename F>
struct Distorted {
    Vec2<F> position;
    F xx, xy, yx, yy;  ///< xy: d position.x / d y
};

/// x'' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y'' likewise.
///
/// Source  OpenCV 4, "Camera Calibration and 3D Reconstruction", detailed description; Brown,
///         "Decentering Distortion of Lenses", 1966
template <typename F>
OBSCURA_INLINE Distorted<F> distort(const Distortion& d, const Vec2<F>& p) {
    const F r2 = p.x * p.x + p.y * p.y;
    const F radial = F(1.0f) + r2 * (F(d.k1) + r2 * (F(d.k2) + r2 * F(d.k3)));
    const F slope = F(d.k1) + r2 * (F(2.0f * d.k2) + r2 * F(3.0f * d.k3));  // d radial / d r2
    const F p1 = F(d.p1);
    const F p2 = F(d.p2);
    const F two = F(2.0f);
    const F xy = p.x * p.y;
    Distorted<F> out;
    out.position = {p.x * radial + two * p1 * xy + p2 * (r2 + two * p.x * p.x),
                    p.y * radial + p1 * (r2 + two * p.y * p.y) + two * p2 * xy};
    out.xx = radial + two * p.x * p.x * slope + two * p1 * p.y + F(6.0f) * p2 * p.x;
    out.yy = radial + two * p.y * p.y * slope + F(6.0f) * p1 * p.y + two * p2 * p.x;
    out.xy = two * xy * slope + two * p1 * p.x + two * p2 * p.y;
    out.yx = out.xy;
    return out;
}

template <typename F>
struct Undistorted {
    Vec2<F> position;
    MaskOf<F> valid;  ///< false: no point within the radius limit maps here
};

/// Inverts `distort` by Newton's method. A lane stops once it has converged, so that its bits do
/// not depend on its neighbours.
template <typename F>
OBSCURA_INLINE Undistorted<F> undistort(const Distortion& d, const Vec2<F>& wanted) {
    const F limit = F(d.radius_limit);
    const F scale = F(1.0f) + abs(wanted.x) + abs(wanted.y);
    const auto within = [&](const Vec2<F>& p) {
        const F r = sqrt(p.x * p.x + p.y * p.y);
        return p * (limit / max(r, limit));
    };
    Vec2<F> p = within(wanted);
    MaskOf<F> arrived(false);
    constexpr int max_steps = 40;  // near the limit each step only halves the distance
    for (int i = 0; i < max_steps; ++i) {
        const Distorted<F> at = distort(d, p);
        const Vec2<F> error = at.position - wanted;
        const F determinant = at.xx * at.yy - at.xy * at.yx;
        const F safe = select(abs(determinant) > F(1e-6f), determinant, F(1e-6f));
        const Vec2<F> step{(at.yy * error.x - at.xy * error.y) / safe,
                           (at.xx * error.y - at.yx * error.x) / safe};
        const Vec2<F> next = within(p - step);
        const F moved = abs(next.x - p.x) + abs(next.y - p.y);
        p = {select(arrived, p.x, next.x), select(arrived, p.y, next.y)};
        arrived = arrived | (moved <= F(std::is_same_v<F, double> ? 1e-14f : 1e-7f) * scale);
        if (all(arrived)) break;
    }
    const Distorted<F> at = distort(d, p);
    const F residual = abs(at.position.x - wanted.x) + abs(at.position.y - wanted.y);
    const F determinant = at.xx * at.yy - at.xy * at.yx;
    const MaskOf<F> valid = (residual <= F(1e-5f) * scale) & (determinant > F(0.0f));
    return {p, valid};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
