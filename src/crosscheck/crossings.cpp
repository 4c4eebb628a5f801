// crosscheck/crossings.cpp - where a line crosses a shape, found by signs alone.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/crossings.h"

#include "crosscheck/shape_side.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

constexpr double rounding = 0x1.0p-53;

/// A quadric's coefficients are single precision: (z - 0.3)^2 is not a square in them. Near the
/// minimum of its left side, values within four roundings count as zero.
constexpr double touch_fraction = 0x1.0p-22;

/// A line whose origin is its closest point to a centre.
struct NearLine {
    Vec3d origin, direction;  ///< the origin relative to the centre
    double start;             ///< t of the origin on the line itself
    double speed;             ///< metres for each unit of t

    NearLine(const TrueRay& line, const Vec3d& centre) : direction(line.direction) {
        const Vec3d from = line.origin - centre;
        start = -dot(from, direction) / dot(direction, direction);
        origin = from + direction * start;
        speed = length(direction);
    }
    Vec3d at(double t) const { return origin + direction * t; }
    Crossings on_line(Crossings found) const {
        for (int k = 0; k < found.count; ++k)
            found.t[k] += start;
        return found;
    }
};

/// A parameter on a line, and the side there.
struct Sample {
    double t, side;
};

/// Where the side changes its sign to or from above 0 between two parameters: by secants, kept away
/// from the ends, and by bisection where these do not help.
template <typename Side>
double change_of_sign(const Side& side, Sample a, Sample b) {
    const double least = 2 * rounding * (std::abs(a.t) + std::abs(b.t));
    bool halve = false;
    for (int i = 0; i < 200 && std::abs(b.t - a.t) > least; ++i) {
        const double width = b.t - a.t;
        const double fraction = halve ? 0.5 : std::clamp(a.side / (a.side - b.side), 0.01, 0.99);
        const double t = a.t + width * fraction;
        if (t == a.t || t == b.t) break;
        const Sample next{t, side(t)};
        ((next.side <= 0) == (a.side <= 0) ? a : b) = next;
        halve = std::abs(b.t - a.t) > 0.5 * std::abs(width);
    }
    return 0.5 * (a.t + b.t);
}

/// Lower bound of any convex function through these three points, the middle one the lowest.
double lower_bound(const Sample& a, const Sample& m, const Sample& b) {
    const double left = m.side + (b.side - m.side) / (b.t - m.t) * (a.t - m.t);
    const double right = m.side + (a.side - m.side) / (a.t - m.t) * (b.t - m.t);
    return std::min(left, right);
}

/// Both crossings of a solid whose side function is convex along the line.
///
/// In   reach_m: the solid lies within this distance of the line's origin
template <typename Side>
Crossings cross_convex(const NearLine& line, double reach_m, const Side& side) {
    const auto along = [&](double t) { return side(line.at(t)); };
    const auto sample = [&](double t) { return Sample{t, along(t)}; };
    const double reach = reach_m / line.speed;
    const double touch = 4 * rounding * (reach_m + length(line.origin));
    Sample a = sample(-reach);
    Sample b = sample(reach);
    Sample m = sample(0);
    constexpr double golden = 0.381966;
    for (int i = 0; i < 100 && m.side > 0 && b.t - a.t > 1e-15 * reach; ++i) {
        if (lower_bound(a, m, b) > touch) return {};
        const bool left = m.t - a.t > b.t - m.t;
        const Sample next = sample(m.t + golden * (left ? a.t - m.t : b.t - m.t));
        if (next.side < m.side) {
            (left ? b : a) = m;
            m = next;
        } else {
            (left ? a : b) = next;
        }
    }
    if (m.side > touch) return {};
    Crossings found;
    found.add(m.side > 0 ? m.t : change_of_sign(along, a, m));
    found.add(m.side > 0 ? m.t : change_of_sign(along, m, b));
    return line.on_line(found);
}

/// Of the corners of a box around the origin, with room.
double reach_of(const Vec3d& half) {
    return 1.01 * length(half);
}

double side_of_box(const Vec3d& half, const Vec3d& p) {
    return std::max({std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z});
}

/// By products alone as long as only existence is asked: the line meets the level at (x, z) / -d.y.
Crossings cross_flat(const ShapeRecord& record, const TrueRay& line) {
    const Vec3d o = line.origin - centre_of(record);
    const Vec3d& d = line.direction;
    const double steep = std::abs(d.y);
    if (!(steep > 0)) return {};
    const double x = std::abs(o.x * d.y - o.y * d.x);
    const double z = std::abs(o.z * d.y - o.y * d.z);
    const Vec3d size = size_of(record);
    const auto within = [&](double place, double half) {
        return half >= static_cast<double>(unbounded) || place <= half * steep;
    };
    const double squared = x * x + z * z;
    const bool met = record.kind == static_cast<int32_t>(ShapeKind::plane)
                         ? within(x, size.x) && within(z, size.y)
                         : squared <= size.x * size.x * steep * steep &&
                               squared >= size.y * size.y * steep * steep;
    Crossings found;
    if (met) found.add(-o.y / d.y);
    return found;
}

/// Signs of a quadric's side along a line; the quadric's centre is the origin.
class QuadricLine {
public:
    static constexpr double slack = 8 * rounding;

    /// In   reach: no t is larger than this
    QuadricLine(const ShapeRecord& record, const NearLine& line, double reach)
        : record_(record),
          line_(line),
          moved_((abs(line.origin) + abs(line.direction) * reach) * slack) {}

    double side(double t) const { return side_of_shape(record_, line_.at(t)); }

    /// Side 0 where rounding has moved the position, or is all that is left of the sum.
    ///
    /// In   fraction: fraction of the terms' sizes that may be rounding
    Sample sample(double t, double fraction = slack) const {
        const double rest = fraction * terms_of_quadric(record_, line_.at(t)) +
                            terms_of_quadric(record_, moved_, 6);
        const double value = side(t);
        return {t, std::abs(value) <= rest ? 0 : value};
    }

    /// The extremum of the side between two parameters, from three samples. Nothing where there is
    /// none.
    double turn(double low, double high) const {
        const double bend = side(low) - 2 * side(0.5 * (low + high)) + side(high);
        return 0.5 * (low + high) - 0.25 * (high - low) * (side(high) - side(low)) / bend;
    }

private:
    const ShapeRecord& record_;
    const NearLine& line_;
    Vec3d moved_;  ///< by rounding, at most
};

void add_change(const QuadricLine& quadric, const Sample& a, const Sample& b, Crossings& found) {
    if (a.side * b.side >= 0) return;
    found.add(change_of_sign([&](double t) { return quadric.side(t); }, a, b));
}

Crossings cross_quadric(const ShapeRecord& record, const NearLine& near) {
    const Vec3d half = size_of(record);
    NearLine own = near;
    own.start = 0;
    const Crossings inside =
        cross_convex(own, reach_of(half), [&](const Vec3d& p) { return side_of_box(half, p); });
    if (inside.count == 0) return {};
    const double reach = std::max(std::abs(inside.t[0]), std::abs(inside.t[1]));
    const QuadricLine quadric(record, near, reach);
    const Sample first = quadric.sample(inside.t[0]);
    const Sample last = quadric.sample(inside.t[1]);
    const double turn = quadric.turn(first.t, last.t);
    Crossings found;
    if (!(turn > first.t && turn < last.t)) {
        add_change(quadric, first, last, found);
        return near.on_line(found);
    }
    const Sample middle = quadric.sample(turn, touch_fraction);
    if (middle.side == 0) {
        if (first.side == 0 && last.side == 0) return {};  // it lies in the surface
        found.add(turn);
        found.add(turn);
        return near.on_line(found);
    }
    add_change(quadric, first, middle, found);
    add_change(quadric, middle, last, found);
    return near.on_line(found);
}

}  // namespace

Crossings cross_shape(const ShapeRecord& record, const TrueRay& line) {
    if (is_flat(record)) return cross_flat(record, line);
    const NearLine near(line, centre_of(record));
    const Vec3d size = size_of(record);
    ShapeRecord own = record;
    std::fill(std::begin(own.centre), std::end(own.centre), 0.0F);
    const auto side = [&](const Vec3d& p) { return side_of_shape(own, p); };
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            if (length(near.origin) > 1.001 * size.x) return {};
            return cross_convex(
                near, 1.01 * size.x, [&](const Vec3d& p) { return length(p) - size.x; });
        case ShapeKind::box:
            return cross_convex(near, reach_of(size), side);
        case ShapeKind::frustum:
            return cross_convex(near, reach_of({size.x, std::max(size.y, size.z), 0}), side);
        case ShapeKind::capsule:
            return cross_hull({{record.centre[0], record.centre[1] - size.x, record.centre[2]},
                               {record.centre[0], record.centre[1] + size.x, record.centre[2]}},
                              {size.y, size.z},
                              line);
        default:
            return cross_quadric(own, near);
    }
}

Crossings cross_hull(const Vec3d (&middle)[2], const double (&radius)[2], const TrueRay& line) {
    const Vec3d centre = (middle[0] + middle[1]) * 0.5;
    const NearLine near(line, centre);
    const Vec3d ends[2] = {middle[0] - centre, middle[1] - centre};
    const double reach = 1.01 * (length(ends[0]) + std::max(radius[0], radius[1]));
    if (length(near.origin) > reach) return {};
    return cross_convex(near, reach, [&](const Vec3d& p) { return side_of_hull(ends, radius, p); });
}

Crossings cross_triangle(const Triangle<double>& triangle, const TrueRay& line) {
    const Vec3d& d = line.direction;
    const Vec3d a = triangle.a - line.origin;
    const Vec3d b = triangle.b - line.origin;
    const Vec3d c = triangle.c - line.origin;
    const double ab = dot(d, cross(a + b, triangle.b - triangle.a));
    const double bc = dot(d, cross(b + c, triangle.c - triangle.b));
    const double ca = dot(d, cross(c + a, triangle.a - triangle.c));
    const bool left = ab >= 0 && bc >= 0 && ca >= 0;
    const bool right = ab <= 0 && bc <= 0 && ca <= 0;
    if (!left && !right) return {};
    const Vec3d normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const double facing = dot(normal, d);
    if (facing == 0) return {};
    Crossings found;
    found.add(dot(normal, a) / facing);
    return found;
}

}  // namespace obscura::crosscheck
