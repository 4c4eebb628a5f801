// session/framing.cpp - automatic views that show a whole asset, from outside.
// SPDX-License-Identifier: Apache-2.0
#include "session/framing.h"

#include "base/setting_names.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

constexpr double min_gap_fraction = 0.1;  ///< of the radius, between the eye and the nearest point

struct Box {
    Vec3d low, high;
};

Vec3d wide(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

/// The bounds as doubles; a stand-in where there is nothing to frame.
Box box_to_frame(const Bounds& bounds) {
    if (bounds.empty()) return {{-1, -1, -1}, {1, 1, 1}};
    const Box box = {wide(bounds.low), wide(bounds.high)};
    const Vec3d centre = (box.low + box.high) * 0.5;
    const double smallest_visible = 1e-6 * max_component(abs(centre));
    if (length(box.high - box.low) > smallest_visible) return box;
    const double half = std::max(1.0, smallest_visible);
    return {centre - splat3(half), centre + splat3(half)};
}

Bounds rounded(const Box& box) {
    const auto narrow = [](const Vec3d& v) {
        return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    return {narrow(box.low), narrow(box.high)};
}

/// Right, up and backward of a view.
struct Axes {
    Vec3d x, y, z;
};

Axes view_axes(const FramingOptions& options) {
    const double around = options.azimuth_rad;
    const double above = options.elevation_rad;
    const Vec3d z = {
        std::sin(around) * std::cos(above), std::sin(above), std::cos(around) * std::cos(above)};
    const Vec3d level = {std::cos(around), 0, -std::sin(around)};  // also straight from above
    const Vec3d upright = cross(z, level);
    const double c = std::cos(options.roll_rad);
    const double s = std::sin(options.roll_rad);
    return {level * c + upright * s, upright * c - level * s, z};
}

/// A point's place across the image in one direction, and towards the eye; relative to the middle
/// of the geometry.
struct Extreme {
    double across, towards;
};

/// What lies at two opposite edges of an image whose edges have a slope: at distance D from the
/// middle all points are seen exactly when high() - slope D <= eye <= low() + slope D.
struct Strip {
    Extreme first, last;
    double slope = 0;
    double low() const { return first.across - slope * first.towards; }
    double high() const { return last.across + slope * last.towards; }
    double centre() const { return 0.5 * (low() + high()); }
    double min_distance() const { return (high() - low()) / (2 * slope); }
};

/// Finds strips in the geometry, for a view along -Z of the axes.
class StripFinder {
public:
    StripFinder(const FramedGeometry& geometry, const Axes& axes, const Vec3d& middle)
        : geometry_(geometry), axes_(axes), middle_(middle) {}

    Strip find(const Vec3d& across, double slope) const {
        const auto extreme = [&](const Vec3d& direction) {
            const Vec3d offset = geometry_.farthest(direction) - middle_;
            return Extreme{dot(offset, across), dot(offset, axes_.z)};
        };
        return {extreme(axes_.z * slope - across), extreme(axes_.z * slope + across), slope};
    }

    /// The strip that just holds all points at a distance. Each step takes the slope at which the
    /// two points that limit the strip lie at its edges: Newton's method for a function that is
    /// convex and piecewise linear, which ends after a few.
    Strip closest(const Vec3d& across, double slope, double distance) const {
        constexpr int max_steps = 20;
        Strip strip = find(across, slope);
        for (int step = 0; step < max_steps; ++step) {
            const double next = (strip.last.across - strip.first.across) /
                                (2 * distance - strip.first.towards - strip.last.towards);
            if (!(next > 0) || std::abs(next - strip.slope) <= 1e-9 * next) break;
            strip = find(across, next);
        }
        return strip;
    }

    double nearest() const { return dot(geometry_.farthest(axes_.z) - middle_, axes_.z); }

private:
    const FramedGeometry& geometry_;
    const Axes& axes_;
    const Vec3d& middle_;
};

/// Where the eye is: across and upward from the middle, and its distance.
struct Eye {
    double x = 0, y = 0, distance = 1;
};

Eye eye_of_tight_view(const StripFinder& finder,
                      const Axes& axes,
                      const std::array<double, 2>& slopes,
                      double gap) {
    const Strip across = finder.find(axes.x, slopes[0]);
    const Strip upward = finder.find(axes.y, slopes[1]);
    const double distance =
        std::max({across.min_distance(), upward.min_distance(), finder.nearest() + gap});
    // Where there is room, the strip of the image's edge would not be centred in perspective.
    return {finder.closest(axes.x, slopes[0], distance).centre(),
            finder.closest(axes.y, slopes[1], distance).centre(),
            distance};
}

}  // namespace

BoundingSphere bounding_sphere(const Bounds& bounds) {
    const Box box = box_to_frame(bounds);
    return {(box.low + box.high) * 0.5, 0.5 * length(box.high - box.low)};
}

Framing frame_view(const FramedGeometry& geometry,
                   const FramingOptions& options,
                   const FrameLens& lens) {
    const Axes axes = view_axes(options);
    const Bounds& bounds = geometry.box();
    const Box box = box_to_frame(bounds);
    const Vec3d middle = (box.low + box.high) * 0.5;
    const bool stands_in = bounds.empty() || length(wide(bounds.low) - box.low) > 0;
    const FramedGeometry corners(rounded(box));
    const FramedGeometry& shown = stands_in ? corners : geometry;
    const double radius = shown.farthest_from(middle);

    const double inside = 1 - 2 * options.margin;
    const double half_height = std::tan(0.5 * lens.yfov_rad);
    const std::array<double, 2> slopes = {inside * half_height * lens.aspect, inside * half_height};
    const StripFinder finder(shown, axes, middle);
    Eye eye;
    Framing framing;
    if (lens.orthographic) {
        const Strip across = finder.find(axes.x, 0);
        const Strip upward = finder.find(axes.y, 0);
        const bool round = options.fit == FrameFit::sphere;
        const double half_x = round ? radius : 0.5 * (across.high() - across.low());
        const double half_y = round ? radius : 0.5 * (upward.high() - upward.low());
        eye = {round ? 0 : across.centre(), round ? 0 : upward.centre(), 2 * radius};
        framing.half_height_m = std::max(half_y, half_x / lens.aspect) / inside;
    } else if (options.fit == FrameFit::sphere) {
        const double slope = std::min(slopes[0], slopes[1]);
        eye.distance = radius * std::sqrt(1 + 1 / (slope * slope));  // a cone that touches the ball
        framing.half_height_m = eye.distance * half_height;
    } else {
        eye = eye_of_tight_view(finder, axes, slopes, min_gap_fraction * radius);
        framing.half_height_m = eye.distance * half_height;
    }
    const Vec3d target = middle + axes.x * eye.x + axes.y * eye.y;
    framing.view = {target + axes.z * eye.distance, target, axes.y};
    framing.half_height_m /= options.zoom;
    framing.tan_half_yfov = half_height / options.zoom;
    return framing;
}

Framing view_inside(const Bounds& bounds, const InsidePlace& place, const FrameLens& lens) {
    FramingOptions direction;
    direction.azimuth_rad = place.azimuth_rad;
    direction.elevation_rad = place.elevation_rad;
    const Axes axes = view_axes(direction);
    const Box box = box_to_frame(bounds);
    const double ahead = 0.5 * length(box.high - box.low);
    const Vec3d eye = box.low + (box.high - box.low) * place.place;
    Framing framing;
    framing.view = {eye, eye - axes.z * ahead, axes.y};
    framing.tan_half_yfov = std::tan(0.5 * lens.yfov_rad);
    framing.half_height_m = ahead * framing.tan_half_yfov;
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
