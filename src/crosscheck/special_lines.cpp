// crosscheck/special_lines.cpp - lines along axes, rulings, edges and surfaces.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/special_lines.h"

#include "crosscheck/crossings.h"
#include "crosscheck/shape_side.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

Vec3d axis(RandomStream& random) {
    const double sign = random.unit() < 0.5 ? -1 : 1;
    const size_t way = random.below(3);
    return {way == 0 ? sign : 0, way == 1 ? sign : 0, way == 2 ? sign : 0};
}

/// Across a direction; any where there is none across.
Vec3d across(const Vec3d& way, RandomStream& random) {
    const Vec3d out = cross(way, random.direction());
    return dot(out, out) > 0 ? normalize(out) : random.direction();
}

/// On the circle around Y at a height.
Vec3d on_ring(double radius, double height, double turn) {
    return {radius * std::cos(turn), height, radius * std::sin(turn)};
}

/// From rim to rim, or along the cone that touches both balls.
Vec3d ruling_of_revolution(const ShapeRecord& record, RandomStream& random) {
    const Vec3d size = size_of(record);
    const double turn = 2 * pi_d * random.unit();
    const double height = 2 * size.x;
    const double wider = size.z - size.y;
    if (record.kind == static_cast<int32_t>(ShapeKind::frustum)) {
        return normalize(on_ring(wider, height, turn));
    }
    const double sine = wider / height;
    return on_ring(sine, std::sqrt(std::max(1 - sine * sine, 0.0)), turn);
}

/// Directions in which the quadratic terms vanish, or all terms do, if there are any.
Vec3d ruling_of_quadric(const ShapeRecord& record, RandomStream& random) {
    const auto k = [&](int i) { return static_cast<double>(record.k[i]); };
    const Vec3d rows[3] = {{2 * k(0), k(3), k(4)}, {k(3), 2 * k(1), k(5)}, {k(4), k(5), 2 * k(2)}};
    const auto bent = [&](const Vec3d& v) {
        return Vec3d{dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
    };
    if (!(length(rows[0]) + length(rows[1]) + length(rows[2]) > 0)) {
        return across({k(6), k(7), k(8)}, random);
    }
    const Vec3d u = random.direction();
    const Vec3d v = random.direction();
    const double a = dot(v, bent(v));
    const double b = dot(u, bent(v));
    const double root = b * b - a * dot(u, bent(u));
    if (root > 0 && random.unit() < 0.7) return normalize(u + v * ((std::sqrt(root) - b) / a));
    const size_t first = random.below(3);
    const Vec3d flat = cross(rows[first], rows[(first + 1) % 3]);
    return dot(flat, flat) > 0 ? normalize(flat) : across(rows[first], random);
}

Vec3d ruling(const ShapeRecord& record, RandomStream& random) {
    if (is_quadric(record)) return ruling_of_quadric(record, random);
    const auto kind = static_cast<ShapeKind>(record.kind);
    if (kind == ShapeKind::frustum || kind == ShapeKind::capsule) {
        return ruling_of_revolution(record, random);
    }
    if (is_flat(record)) return across({0, 1, 0}, random);
    return axis(random);
}

/// Where random lines meet the shape.
Vec3d point_on(const ShapeRecord& record, RandomStream& random) {
    for (int i = 0; i < 4; ++i) {
        const TrueRay line{point_near(record, 1, random), random.direction()};
        const Crossings met = cross_shape(record, line);
        if (met.count > 0) return line.origin + line.direction * met.t[0];
    }
    return centre_of(record);
}

/// Positions relative to the centre: on rims, at corners and on edges of boxes, at apexes of cones.
Vec3d point_at_edge(const ShapeRecord& record, RandomStream& random) {
    const Vec3d size = size_of(record);
    const double turn = 2 * pi_d * random.unit();
    const double side = random.unit() < 0.5 ? -1 : 1;
    const auto end = [&](double half) { return random.unit() < 0.5 ? -half : half; };
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::frustum:
        case ShapeKind::capsule:
            return on_ring(side < 0 ? size.y : size.z, side * size.x, turn);
        case ShapeKind::disk:
            return on_ring(side < 0 ? size.y : size.x, 0, turn);
        case ShapeKind::plane:
            return {end(std::min(size.x, 1.0)), 0, random.between(-1, 1) * std::min(size.y, 1.0)};
        case ShapeKind::box:
            return {end(size.x), end(size.y), random.between(-1, 1) * size.z};
        default:
            return {0, 0, 0};
    }
}

}  // namespace

Vec3d point_near(const ShapeRecord& record, double wider, RandomStream& random) {
    const ShapeBox box = shape_bounds(record);
    const auto along = [&](float centre, float low, float high) {
        const bool ends = std::abs(low) < 1e18f && std::abs(high) < 1e18f;
        const double half = ends ? 0.5 * (static_cast<double>(high) - static_cast<double>(low)) : 1;
        return static_cast<double>(centre) + random.between(-1, 1) * half * wider;
    };
    return {along(record.centre[0], box.low.x, box.high.x),
            along(record.centre[1], box.low.y, box.high.y),
            along(record.centre[2], box.low.z, box.high.z)};
}

TrueRay special_line(const ShapeRecord& record, RandomStream& random) {
    const size_t where = random.below(4);
    const Vec3d point = where == 0   ? centre_of(record)
                        : where == 1 ? centre_of(record) + point_at_edge(record, random)
                        : where == 2 ? point_on(record, random)
                                     : point_near(record, 1.2, random);
    const size_t along = random.below(3);
    return {point,
            along == 0   ? axis(random)
            : along == 1 ? ruling(record, random)
                         : across(normal_of_shape(record, point), random)};
}

TrueRay special_line(const Triangle<double>& triangle, RandomStream& random) {
    const Vec3d corner[3] = {triangle.a, triangle.b, triangle.c};
    const size_t first = random.below(3);
    const Vec3d edge = corner[(first + 1) % 3] - corner[first];
    const Vec3d other = corner[(first + 2) % 3] - corner[first];
    const size_t where = random.below(3);
    const double u = where == 0 ? 0 : random.between(-0.2, 1.2);
    const double v = where == 2 ? random.between(-0.2, 1.2) : 0;
    const Vec3d normal = cross(edge, other);
    const size_t along = random.below(4);
    const Vec3d way = along == 0   ? axis(random)
                      : along == 1 ? edge
                      : along == 2 ? across(normal, random)
                                   : random.direction();
    const double size = length(way);
    return {corner[first] + edge * u + other * v, size > 0 ? way * (1 / size) : random.direction()};
}

}  // namespace obscura::crosscheck
