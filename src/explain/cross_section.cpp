// explain/cross_section.cpp - cuts the scene by the plane that holds a ray and a normal.
// SPDX-License-Identifier: Apache-2.0
#include "explain/cross_section.h"

#include "crosscheck/shape_side.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {

namespace {

constexpr size_t max_outlines = 4000;
constexpr size_t max_curved = 64;  ///< limit on shapes that need a grid
constexpr int grid_side = 96;

/// A vector across the ray, towards `wished` where possible; arbitrary where that is along the ray.
Vec3d across_towards(const Vec3d& along, const Vec3d& wished) {
    for (const Vec3d& v : {wished, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}) {
        const Vec3d across = v - along * dot(v, along);
        if (length(across) > 0.02 * length(v)) return across * (1 / length(across));
    }
    return {0, 0, 1};
}

/// The part of the ray that is shown: from its origin to a little behind its hit, without a long
/// empty stretch before it.
void choose_window(const PixelReport& report, double aspect, CrossSection& out) {
    double first = INFINITY;
    double last = 0;
    const double reach =
        report.seen ? report.objects[report.seen->object].t : static_cast<double>(INFINITY);
    for (const Candidate& object : report.objects) {
        for (const double t : object.working.t) {
            if (!(t > 0) || !std::isfinite(object.t)) continue;
            if (t > 1.7 * reach) continue;
            first = std::min(first, t);
            last = std::max(last, t);
        }
    }
    if (!std::isfinite(first)) first = last = 1;
    const double spread = std::max(last - first, 0.12 * last);
    const double low = first - 1.6 * spread;
    out.x_low = low < 0.5 * last ? -0.06 * last : low;
    out.x_high = last + std::max(0.15 * (last - out.x_low), 0.2 * spread);
    out.half_height = 0.5 * (out.x_high - out.x_low) / aspect;
}

/// Where the plane cuts a flat polygon: between the first two edges that it crosses.
void cut_polygon(const CrossSection& plane, const std::vector<Vec3d>& corners, Outline& out) {
    std::vector<PlanePoint> ends;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3d& a = corners[i];
        const Vec3d& b = corners[(i + 1) % corners.size()];
        const double side_a = dot(a - plane.origin, plane.out);
        const double side_b = dot(b - plane.origin, plane.out);
        if ((side_a < 0) == (side_b < 0)) continue;
        ends.push_back(plane.project(a + (b - a) * (side_a / (side_a - side_b))));
    }
    if (ends.size() == 2) out.segments.push_back({ends[0], ends[1]});
}

/// A flat shape as a polygon in the world.
std::vector<Vec3d> flat_corners(const ShapeRecord& record,
                                const Affined& world,
                                double far,
                                int side) {
    const Vec3d centre{record.centre[0], record.centre[1], record.centre[2]};
    std::vector<Vec3d> corners;
    const bool disk = record.kind == static_cast<int32_t>(ShapeKind::disk);
    const int count = disk ? 72 : 4;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * pi_d * (i + 0.5) / count;
        double x = std::cos(angle) * static_cast<double>(record.size[side]);
        double z = std::sin(angle) * static_cast<double>(record.size[side]);
        if (!disk) {
            x = std::copysign(std::min<double>(record.size[0], far), x);
            z = std::copysign(std::min<double>(record.size[1], far), z);
        }
        corners.push_back(transform_point(world, centre + Vec3d{x, 0, z}));
    }
    return corners;
}

void cut_flat(const CrossSection& plane, const crosscheck::TrueScene& scene, Outline& out) {
    const ShapeRecord record = scene.shape(out.item);
    const Affined world = scene.world_from_object(out.item);
    // Infinite planes reach out of the drawing, wherever their centre is.
    const double far = 1e3 * (plane.x_high - plane.x_low) +
                       2 * length(transform_point(scene.object_from_world(out.item), plane.origin));
    cut_polygon(plane, flat_corners(record, world, far, 0), out);
    const bool ring = record.kind == static_cast<int32_t>(ShapeKind::disk) && record.size[1] > 0.0f;
    if (!ring || out.segments.empty()) return;
    Outline hole{out.item, {}};
    cut_polygon(plane, flat_corners(record, world, far, 1), hole);
    if (hole.segments.empty()) return;
    const PlaneSegment whole = out.segments[0];
    PlaneSegment gap = hole.segments[0];
    const auto fraction = [&](const PlanePoint& p) {
        return (p.x - whole.from.x) * (whole.to.x - whole.from.x) +
               (p.y - whole.from.y) * (whole.to.y - whole.from.y);
    };
    if (fraction(gap.to) < fraction(gap.from)) std::swap(gap.from, gap.to);
    out.segments = {{whole.from, gap.from}, {gap.to, whole.to}};
}

/// A part of the plane.
struct Window {
    double x_low, x_high, y_low, y_high;
};

/// Clips a shape's box to the drawing.
Window window_of(const CrossSection& plane, const ShapeRecord& record, const Affined& world) {
    const ShapeBox box = shape_bounds(record);
    Window out{INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (int k = 0; k < 8; ++k) {
        const PlanePoint p =
            plane.project(transform_point(world,
                                          Vec3d{(k & 1) != 0 ? box.high.x : box.low.x,
                                                (k & 2) != 0 ? box.high.y : box.low.y,
                                                (k & 4) != 0 ? box.high.z : box.low.z}));
        out = {std::min(out.x_low, p.x),
               std::max(out.x_high, p.x),
               std::min(out.y_low, p.y),
               std::max(out.y_high, p.y)};
    }
    return {std::max(out.x_low, plane.x_low),
            std::min(out.x_high, plane.x_high),
            std::max(out.y_low, -plane.half_height),
            std::min(out.y_high, plane.half_height)};
}

/// Draws the zero of a function in one square of a grid, from its values at the corners.
void add_cell(const PlanePoint (&p)[4], const double (&value)[4], Outline& out) {
    PlanePoint ends[4];
    int count = 0;
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4;
        if (std::isnan(value[i]) || std::isnan(value[j])) return;
        if ((value[i] < 0) == (value[j] < 0)) continue;
        const double fraction = value[i] / (value[i] - value[j]);
        ends[count++] = {p[i].x + (p[j].x - p[i].x) * fraction,
                         p[i].y + (p[j].y - p[i].y) * fraction};
    }
    if (count >= 2) out.segments.push_back({ends[0], ends[1]});
    if (count == 4) out.segments.push_back({ends[2], ends[3]});
}

/// A round shape by the sign of its own definition on a grid ("marching squares").
void cut_round(const CrossSection& plane, const crosscheck::TrueScene& scene, Outline& out) {
    const ShapeRecord record = scene.shape(out.item);
    const Affined object = scene.object_from_world(out.item);
    const Window window = window_of(plane, record, scene.world_from_object(out.item));
    if (!(window.x_low < window.x_high) || !(window.y_low < window.y_high)) return;
    const bool boxed = record.kind == static_cast<int32_t>(ShapeKind::quadric) ||
                       record.kind == static_cast<int32_t>(ShapeKind::quadric_from_above);
    const auto value = [&](const PlanePoint& at) {
        const Vec3d p =
            transform_point(object, plane.origin + plane.along * at.x + plane.across * at.y);
        const double off[3] = {p.x - static_cast<double>(record.centre[0]),
                               p.y - static_cast<double>(record.centre[1]),
                               p.z - static_cast<double>(record.centre[2])};
        for (int i = 0; boxed && i < 3; ++i) {
            if (std::abs(off[i]) > static_cast<double>(record.size[i])) {
                return std::numeric_limits<double>::quiet_NaN();
            }
        }
        return crosscheck::side_of_shape(record, p);
    };
    const double dx = (window.x_high - window.x_low) / (grid_side - 2);
    const double dy = (window.y_high - window.y_low) / (grid_side - 2);
    const auto position = [&](int i, int j) {
        return PlanePoint{window.x_low + (i - 1) * dx, window.y_low + (j - 1) * dy};
    };
    std::vector<double> values;
    for (int j = 0; j <= grid_side; ++j) {
        for (int i = 0; i <= grid_side; ++i)
            values.push_back(value(position(i, j)));
    }
    const auto at = [&](int i, int j) {
        const int number = j * (grid_side + 1) + i;
        return values[static_cast<size_t>(number)];
    };
    for (int j = 0; j < grid_side; ++j) {
        for (int i = 0; i < grid_side; ++i) {
            add_cell(
                {position(i, j), position(i + 1, j), position(i + 1, j + 1), position(i, j + 1)},
                {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
                out);
        }
    }
}

bool is_flat(const crosscheck::TrueScene& scene, const crosscheck::Item& item) {
    if (scene.is_triangle(item)) return true;
    const auto kind = static_cast<ShapeKind>(scene.shape(item).kind);
    return kind == ShapeKind::plane || kind == ShapeKind::disk;
}

/// Clips a segment to the drawing; false: none of it is inside.
/// Source  Liang and Barsky, "A New Concept and Method for Line Clipping", ACM TOG 3(1), 1984
bool clip(const Window& window, PlaneSegment& segment) {
    const PlanePoint from = segment.from;
    const double dx = segment.to.x - from.x;
    const double dy = segment.to.y - from.y;
    double enter = 0;
    double leave = 1;
    const double sides[4][2] = {{-dx, from.x - window.x_low},
                                {dx, window.x_high - from.x},
                                {-dy, from.y - window.y_low},
                                {dy, window.y_high - from.y}};
    for (const auto& [towards, room] : sides) {
        if (towards == 0 && room < 0) return false;
        if (towards < 0) enter = std::max(enter, room / towards);
        if (towards > 0) leave = std::min(leave, room / towards);
    }
    segment = {{from.x + dx * enter, from.y + dy * enter},
               {from.x + dx * leave, from.y + dy * leave}};
    return enter < leave;
}

Outline outline_of(const CrossSection& plane,
                   const crosscheck::TrueScene& scene,
                   const crosscheck::Item& item) {
    Outline out{item, {}};
    if (scene.is_triangle(item)) {
        const Triangle<double> t = scene.triangle(item);
        cut_polygon(plane, {t.a, t.b, t.c}, out);
    } else if (is_flat(scene, item)) {
        cut_flat(plane, scene, out);
    } else {
        cut_round(plane, scene, out);
    }
    const Window window{plane.x_low, plane.x_high, -plane.half_height, plane.half_height};
    std::erase_if(out.segments, [&](PlaneSegment& segment) { return !clip(window, segment); });
    return out;
}

}  // namespace

CrossSection cut_scene(const crosscheck::TrueScene& scene,
                       const PixelReport& report,
                       double aspect) {
    CrossSection out;
    const crosscheck::TrueRay& ray = report.working.ray;
    out.origin = ray.origin;
    out.along = ray.direction;
    out.across = across_towards(out.along, report.seen ? report.seen->face : Vec3d{0, 1, 0});
    // The drawing's vertical is the world's up, as far as the plane allows.
    if (out.across.y < 0) out.across = out.across * -1.0;
    out.out = cross(out.along, out.across);
    choose_window(report, aspect, out);
    size_t curved = 0;
    const auto add = [&](const crosscheck::Item& item) {
        if (out.outlines.size() >= max_outlines) return;
        if (!is_flat(scene, item) && ++curved > max_curved) return;
        Outline outline = outline_of(out, scene, item);
        if (!outline.segments.empty()) out.outlines.push_back(std::move(outline));
    };
    const auto is_listed = [&](const crosscheck::Item& item) {
        return std::any_of(report.objects.begin(),
                           report.objects.end(),
                           [&](const Candidate& object) { return object.item == item; });
    };
    for (const Candidate& object : report.objects)
        add(object.item);
    scene.near_items(ray, out.half_height, [&](const crosscheck::Item& item) {
        if (!is_listed(item)) add(item);
    });
    return out;
}

}  // namespace obscura
