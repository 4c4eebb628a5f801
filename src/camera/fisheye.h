// camera/fisheye.h - fisheye cameras: the angle from the axis determines the radius on the film.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera_ray.h"
#include "math/warp.h"

namespace obscura {

/// Radius r on a film at distance 1 of a ray at angle theta from the axis.
///
/// To add one: append it here, give it a case in fisheye_radius and in fisheye_angle below, its
/// largest angle in camera/fisheye.cpp, a name in camera/names.h, its formula in
/// explain/camera_working.cpp, its closed form in tests/camera, and a line in docs/cameras.md and
/// in the schema of docs/extensions/OBSCURA_camera.
enum class FisheyeLaw : int {
    equidistant,    ///< r = theta
    equisolid,      ///< r = 2 sin(theta / 2)
    stereographic,  ///< r = 2 tan(theta / 2)
    orthographic,   ///< r = sin(theta)
    opencv          ///< r = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
};

struct FisheyeCamera {
    FisheyeLaw law = FisheyeLaw::equidistant;
    float half_width = 1;  ///< radius at the centre of the right edge
    float half_height = 1;
    float shift_x = 0;  ///< of the film, as a radius; positive: sees more right
    float shift_y = 0;  ///< positive: sees more above
    float k[4] = {0, 0, 0, 0};
    float largest_angle = 1.5707963f;   ///< half the field of view, radians; in (0, pi]
    float largest_radius = 1.5707963f;  ///< that of largest_angle
    float pixel_spread = 0.001f;        ///< 2 * half_height / image height in pixels
};

/// The largest angle up to which the radius grows (at most pi): the edge of the image circle.
double largest_fisheye_angle(FisheyeLaw law, const double k[4]);

inline namespace OBSCURA_ISA {

/// r(theta) of the four-coefficient model, and its derivative.
///
/// Source  Kannala and Brandt, "A Generic Camera Model and Calibration Method", PAMI 28(8), 2006;
///         OpenCV 4, "Fisheye camera model"
template <typename F>
struct OpenCvRadius {
    F radius, slope;
};

template <typename F>
OBSCURA_INLINE OpenCvRadius<F> opencv_radius(const FisheyeCamera& camera, const F& theta) {
    const F s = theta * theta;
    const F k1 = F(camera.k[0]);
    const F k2 = F(camera.k[1]);
    const F k3 = F(camera.k[2]);
    const F k4 = F(camera.k[3]);
    return {
        theta * (F(1.0f) + s * (k1 + s * (k2 + s * (k3 + s * k4)))),
        F(1.0f) + s * (F(3.0f) * k1 + s * (F(5.0f) * k2 + s * (F(7.0f) * k3 + s * F(9.0f) * k4)))};
}

/// Source  Miyamoto, "Fish Eye Lens", JOSA 54(8), 1964, for the four classical laws
template <typename F>
OBSCURA_INLINE F fisheye_radius(const FisheyeCamera& camera, const F& theta) {
    const F half = F(0.5f) * theta;
    switch (camera.law) {
        case FisheyeLaw::equidistant:
            break;
        case FisheyeLaw::equisolid:
            return F(2.0f) * sin_cos(half).sin;
        case FisheyeLaw::stereographic:
            return F(2.0f) * sin_cos(half).sin / sin_cos(half).cos;
        case FisheyeLaw::orthographic:
            return sin_cos(theta).sin;
        case FisheyeLaw::opencv:
            return opencv_radius(camera, theta).radius;
    }
    return theta;
}

/// A ray's angle from the axis, with the values that the ray is made from.
template <typename F>
struct FisheyeAngle {
    F sin_over_radius;
    F cos;
    F slope;  ///< d theta / d r
};

template <typename F>
OBSCURA_INLINE FisheyeAngle<F> angle_from_theta(const F& theta, const F& radius, const F& slope) {
    const auto apart = radius > F(0.0f);
    const SinCos<F> turned = sin_cos(theta);
    return {select(apart, turned.sin / select(apart, radius, F(1.0f)), F(1.0f)), turned.cos, slope};
}

/// Inverts the four-coefficient model by Newton's method inside a bracket. A lane stops once it has
/// converged, so that its bits do not depend on its neighbours.
template <typename F>
OBSCURA_INLINE F opencv_angle(const FisheyeCamera& camera, const F& radius) {
    F low = F(0.0f);
    F high = F(camera.largest_angle);
    F theta = min(radius, high);
    MaskOf<F> arrived(false);
    constexpr int max_steps = 60;
    for (int i = 0; i < max_steps; ++i) {
        const OpenCvRadius<F> at = opencv_radius(camera, theta);
        const auto beyond = at.radius > radius;
        high = select(beyond, theta, high);
        low = select(beyond, low, theta);
        const F newton = theta - (at.radius - radius) / max(at.slope, F(1e-6f));
        const MaskOf<F> inside = (newton >= low) & (newton <= high);
        const F next = select(inside, newton, F(0.5f) * (low + high));
        const F moved = abs(next - theta);
        theta = select(arrived, theta, next);
        arrived = arrived | (moved <= F(std::is_same_v<F, double> ? 1e-15f : 1e-7f));
        if (all(arrived)) break;
    }
    return theta;
}

/// In      radius: in [0, largest_radius]
template <typename F>
OBSCURA_INLINE FisheyeAngle<F> fisheye_angle(const FisheyeCamera& camera, const F& radius) {
    const F one = F(1.0f);
    const F half = F(0.5f) * radius;
    const F square = half * half;
    const F least = F(0.05f);  // the footprint stays finite where the law ends
    switch (camera.law) {
        case FisheyeLaw::equidistant:
            break;
        case FisheyeLaw::equisolid: {  // half = sin(theta / 2)
            const F half_cos = sqrt(max(one - square, F(0.0f)));
            return {half_cos, one - F(2.0f) * square, one / max(half_cos, least)};
        }
        case FisheyeLaw::stereographic: {  // half = tan(theta / 2)
            const F scale = one / (one + square);
            return {scale, (one - square) * scale, scale};
        }
        case FisheyeLaw::orthographic: {
            const F cosine = sqrt(max(one - radius * radius, F(0.0f)));
            return {one, cosine, one / max(cosine, least)};
        }
        case FisheyeLaw::opencv: {
            const F theta = opencv_angle(camera, radius);
            const F slope = one / max(opencv_radius(camera, theta).slope, least);
            return angle_from_theta(theta, radius, slope);
        }
    }
    return angle_from_theta(radius, radius, one);
}

/// Rays outside the image circle (largest_radius) are invalid.
template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const FisheyeCamera& camera, const FilmPoint<F>& point) {
    const F x = (F(2.0f) * point.film.x - F(1.0f)) * F(camera.half_width) + F(camera.shift_x);
    const F y = (F(1.0f) - F(2.0f) * point.film.y) * F(camera.half_height) + F(camera.shift_y);
    const F radius = sqrt(x * x + y * y);
    const auto valid = radius <= F(camera.largest_radius);
    const FisheyeAngle<F> angle = fisheye_angle(camera, min(radius, F(camera.largest_radius)));
    const F across = select(valid, angle.sin_over_radius, F(0.0f));
    const F along = select(valid, angle.cos, F(1.0f));
    const Vec3<F> direction{x * across, y * across, -along};
    return {splat3(F(0.0f)),
            normalize(direction),
            F(0.0f),
            F(camera.pixel_spread) * angle.slope,
            valid};
}

/// Projects a position in camera space, within the field of view, to the film.
template <typename F>
OBSCURA_INLINE Vec2<F> film_from_fisheye(const FisheyeCamera& camera, const Vec3<F>& p) {
    const F across = sqrt(p.x * p.x + p.y * p.y);
    const F radius = fisheye_radius(camera, atan2(across, -p.z));
    const F scale = select(across > F(0.0f), radius / max(across, F(1e-30f)), F(0.0f));
    return {((p.x * scale - F(camera.shift_x)) / F(camera.half_width) + F(1.0f)) * F(0.5f),
            (F(1.0f) - (p.y * scale - F(camera.shift_y)) / F(camera.half_height)) * F(0.5f)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
