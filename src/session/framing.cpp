// session/framing.cpp - automatic views that show a whole asset, from outside.
// SPDX-License-Identifier: Apache-2.0
#include "session/framing.h"

#include "base/setting_names.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double frame_fraction = 0.95;   ///< of the half frame that the corners may fill
constexpr double azimuth = pi / 6;        ///< from +Z towards +X: the viewer's right
constexpr double elevation = pi / 9;      ///< above the horizon
constexpr double min_gap_fraction = 0.1;  ///< of the radius, between the eye and the nearest corner

struct Box {
    Vec3d low, high;
};

/// The bounds as doubles; a stand-in where there is nothing to frame.
Box box_to_frame(const Bounds& bounds) {
    if (bounds.empty()) return {{-1, -1, -1}, {1, 1, 1}};
    const auto widen = [](const Vec3f& v) { return Vec3d{v.x, v.y, v.z}; };
    const Box box = {widen(bounds.low), widen(bounds.high)};
    const Vec3d centre = (box.low + box.high) * 0.5;
    const double smallest_visible = 1e-6 * max_component(abs(centre));
    if (length(box.high - box.low) > smallest_visible) return box;
    const double half = std::max(1.0, smallest_visible);
    return {centre - splat3(half), centre + splat3(half)};
}

/// Right, up and backward of the automatic view.
struct Axes {
    Vec3d x, y, z;
};

Axes automatic_axes() {
    const Vec3d z = {std::sin(azimuth) * std::cos(elevation),
                     std::sin(elevation),
                     std::cos(azimuth) * std::cos(elevation)};
    const Vec3d x = normalize(cross(Vec3d{0, 1, 0}, z));
    return {x, cross(z, x), z};
}

/// The box's corners relative to its centre, along the axes of the automatic view.
std::array<Vec3d, 8> corners_in_view(const Box& box, const Axes& axes) {
    const Vec3d half = (box.high - box.low) * 0.5;
    std::array<Vec3d, 8> corners = {};
    for (size_t i = 0; i < 8; ++i) {
        const Vec3d corner = {(i & 1) != 0 ? half.x : -half.x,
                              (i & 2) != 0 ? half.y : -half.y,
                              (i & 4) != 0 ? half.z : -half.z};
        corners[i] = {dot(corner, axes.x), dot(corner, axes.y), dot(corner, axes.z)};
    }
    return corners;
}

/// The strip that holds every corner's view cone in one direction, for a slope of the frame's edge:
/// at distance D all corners are inside exactly when high - slope D <= eye <= low + slope D.
struct Strip {
    double low = 1e300;
    double high = -1e300;
    void add(double across, double towards_eye, double slope) {
        low = std::min(low, across - slope * towards_eye);
        high = std::max(high, across + slope * towards_eye);
    }
    double centre() const { return 0.5 * (low + high); }
};

}  // namespace

BoundingSphere bounding_sphere(const Bounds& bounds) {
    const Box box = box_to_frame(bounds);
    return {(box.low + box.high) * 0.5, 0.5 * length(box.high - box.low)};
}

Framing frame_perspective(const Bounds& bounds, double yfov_rad, double aspect) {
    const Axes axes = automatic_axes();
    const Box box = box_to_frame(bounds);
    const BoundingSphere sphere = bounding_sphere(bounds);
    const double half_height = std::tan(0.5 * yfov_rad);
    const double slope_x = frame_fraction * half_height * aspect;
    const double slope_y = frame_fraction * half_height;
    Strip across;
    Strip upward;
    double nearest = 0;
    for (const Vec3d& corner : corners_in_view(box, axes)) {
        across.add(corner.x, corner.z, slope_x);
        upward.add(corner.y, corner.z, slope_y);
        nearest = std::max(nearest, corner.z);
    }
    const double distance = std::max({(across.high - across.low) / (2 * slope_x),
                                      (upward.high - upward.low) / (2 * slope_y),
                                      nearest + min_gap_fraction * sphere.radius_m});
    const Vec3d target = sphere.centre_m + axes.x * across.centre() + axes.y * upward.centre();
    Framing framing;
    framing.view = {target + axes.z * distance, target, {0, 1, 0}};
    framing.half_height_m = distance * half_height;
    return framing;
}

Framing frame_orthographic(const Bounds& bounds, double aspect) {
    const Axes axes = automatic_axes();
    const BoundingSphere sphere = bounding_sphere(bounds);
    double half_width = 0;
    double half_height = 0;
    for (const Vec3d& corner : corners_in_view(box_to_frame(bounds), axes)) {
        half_width = std::max(half_width, std::abs(corner.x));
        half_height = std::max(half_height, std::abs(corner.y));
    }
    Framing framing;
    framing.half_height_m = std::max(half_height, half_width / aspect) / frame_fraction;
    framing.view = {sphere.centre_m + axes.z * (2 * sphere.radius_m), sphere.centre_m, {0, 1, 0}};
    return framing;
}

Result<Affined> look_at(const Viewpoint& view) {
    const Vec3d backward = view.eye_m - view.target_m;
    const double distance = length(backward);
    const double scale =
        std::max(max_component(abs(view.eye_m)), max_component(abs(view.target_m)));
    if (!(distance > 1e-12 * scale)) {
        return fail(ExitCode::usage,
                    "E-CAM-VIEW",
                    setting("eye"),
                    "the eye and the target are the same point; give an " + setting("eye") +
                        " that differs from " + setting("target"));
    }
    const Vec3d z = backward * (1 / distance);
    const double up_length = length(view.up);
    const Vec3d right = cross(view.up, z);
    const double right_length = length(right);
    if (!(up_length > 0) || !(right_length > 1e-6 * up_length)) {
        return fail(ExitCode::usage,
                    "E-CAM-VIEW",
                    setting("up"),
                    "the up direction is zero or parallel to the view; give an " + setting("up") +
                        " that is not");
    }
    const Vec3d x = right * (1 / right_length);
    const Vec3d y = cross(z, x);
    return Affined{{{x.x, y.x, z.x, view.eye_m.x},
                    {x.y, y.y, z.y, view.eye_m.y},
                    {x.z, y.z, z.z, view.eye_m.z}}};
}

Result<Affined> rigid_part(const Affined& world_from_node, const std::string& where) {
    const auto& m = world_from_node.m;
    const auto column = [&](int c) { return Vec3d{m[0][c], m[1][c], m[2][c]}; };
    const double y_length = length(column(1));
    const double z_length = length(column(2));
    const Vec3d z = column(2) * (z_length > 0 ? 1 / z_length : 0);
    const Vec3d up = column(1) * (y_length > 0 ? 1 / y_length : 0);
    const Vec3d right = cross(up, z);
    const double right_length = length(right);
    if (!(right_length > 1e-9) || !std::isfinite(right_length)) {
        return fail(ExitCode::bad_data,
                    "E-CAM-SINGULAR",
                    where,
                    "the camera's node has a matrix that flattens its view; expected one whose "
                    "second and third columns are not zero and not parallel");
    }
    const Vec3d x = right * (1 / right_length);
    const Vec3d y = cross(z, x);
    return Affined{{{x.x, y.x, z.x, m[0][3]}, {x.y, y.y, z.y, m[1][3]}, {x.z, y.z, z.z, m[2][3]}}};
}

}  // namespace obscura
