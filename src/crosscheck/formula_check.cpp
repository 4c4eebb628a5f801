// crosscheck/formula_check.cpp - the formulas in double against what a point's own place says.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/formula_check.h"

#include "base/parallel.h"
#include "crosscheck/random.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace obscura {

namespace {

constexpr size_t block_size = 1024;

/// Distance from the axis less the radius at that height.
double side_of_cone(const Vec3d& p, double half_height, double bottom, double top) {
    const double share = (p.y + half_height) / (2 * half_height);
    const double radius = bottom + (top - bottom) * share;
    return std::max(std::hypot(p.x, p.z) - radius, std::abs(p.y) - half_height);
}

/// A capsule holds the balls around all points of its axis, their radii in proportion: the nearest
/// ball's surface, by a search over the axis, for the difference is convex along it.
double side_of_capsule(const Vec3d& p, double half_height, double bottom, double top) {
    const auto side = [&](double share) {
        const double y = half_height * (2 * share - 1);
        return std::hypot(p.x, p.y - y, p.z) - (bottom + (top - bottom) * share);
    };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 100; ++i) {
        const double a = low + (high - low) / 3;
        const double b = high - (high - low) / 3;
        (side(a) < side(b) ? high : low) = side(a) < side(b) ? b : a;
    }
    return side(0.5 * (low + high));
}

double side_of_quadric(const float (&k)[10], const Vec3d& p) {
    const double monomials[10] = {
        p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.x * p.z, p.y * p.z, p.x, p.y, p.z, 1};
    double sum = 0;
    for (size_t i = 0; i < 10; ++i)
        sum += static_cast<double>(k[i]) * monomials[i];
    return sum;
}

/// A point in a box of a shape's size around its centre, or `wider` times as far.
Vec3d near_shape(const ShapeRow& row, double wider, RandomStream& random) {
    const ShapeBox box = shape_bounds(row);
    const auto along = [&](float centre, float low, float high) {
        const bool ends = std::abs(low) < 1e18f && std::abs(high) < 1e18f;
        const double half = ends ? 0.5 * (static_cast<double>(high) - static_cast<double>(low)) : 1;
        return static_cast<double>(centre) + random.between(-1, 1) * half * wider;
    };
    return {along(row.centre[0], box.low.x, box.high.x),
            along(row.centre[1], box.low.y, box.high.y),
            along(row.centre[2], box.low.z, box.high.z)};
}

bool is_open(ShapeKind kind) {
    return kind == ShapeKind::plane || kind == ShapeKind::disk;
}

/// Whether the place where a segment crosses the level of a flat shape is on it.
bool is_on_flat(const ShapeRow& row, const Vec3d& p) {
    const double x = p.x - static_cast<double>(row.centre[0]);
    const double z = p.z - static_cast<double>(row.centre[2]);
    const double a = static_cast<double>(row.size[0]);
    const double b = static_cast<double>(row.size[1]);
    if (static_cast<ShapeKind>(row.kind) == ShapeKind::plane) {
        return std::abs(x) <= a && std::abs(z) <= b;
    }
    return std::hypot(x, z) <= a && std::hypot(x, z) >= b;
}

size_t meetings_on_segment(const ShapeRow& row, const Vec3d& a, const Vec3d& b) {
    const Roots<double> roots = intersect_shape<double>(row, ShapeRay<double>{a, b - a});
    size_t count = 0;
    for (int k = 0; k < 2; ++k) {
        const bool same = k == 1 && roots.hit[0] && roots.t[0] == roots.t[1];  // flat shapes
        count += roots.hit[k] && !same && roots.t[k] > 0 && roots.t[k] < 1 ? 1 : 0;
    }
    return count;
}

bool is_shape_right(const ShapeRow& row, RandomStream& random) {
    const auto kind = static_cast<ShapeKind>(row.kind);
    const bool quadric = kind == ShapeKind::quadric || kind == ShapeKind::quadric_from_above;
    // A quadric's equation holds beyond its box, where the box has cut it off.
    Vec3d a = near_shape(row, quadric ? 0.999 : 1.3, random);
    Vec3d b = near_shape(row, quadric ? 0.999 : 1.3, random);
    if (is_open(kind)) {
        a.y += random.between(0.1, 1);
        b.y -= random.between(0.1, 1);
    }
    const double side_a = side_of_shape(row, a);
    const double side_b = side_of_shape(row, b);
    bool odd = (side_a < 0) != (side_b < 0);
    if (is_open(kind)) {
        const double share = side_a / (side_a - side_b);
        odd = odd && is_on_flat(row, a + (b - a) * share);
    }
    return (meetings_on_segment(row, a, b) % 2 == 1) == odd;
}

bool is_triangle_right(const Triangle<double>& t, RandomStream& random) {
    const double u = random.between(-0.5, 1.5);
    const double v = random.between(-0.5, 1.5);
    const Vec3d normal = cross(t.b - t.a, t.c - t.a);
    const double size = std::max(length(t.b - t.a), length(t.c - t.a));
    if (length(normal) < 1e-7 * size * size) return true;  // too thin to have an inside
    const Vec3d place = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
    const Vec3d off = (normalize(normal) + random.direction() * 0.7) * size;
    const TriangleHit<double> hit =
        intersect_triangle(t, ShapeRay<double>{place + off, off * -2.0});
    const double inside = std::min({u, v, 1 - u - v});
    if (std::abs(inside) < 1e-6) return true;
    return hit.hit == (inside > 0) && (!hit.hit || std::abs(hit.t - 0.5) < 1e-6);
}

}  // namespace

double side_of_shape(const ShapeRow& row, const Vec3d& point) {
    const Vec3d p = point - Vec3d{row.centre[0], row.centre[1], row.centre[2]};
    const double a = static_cast<double>(row.size[0]);
    const double b = static_cast<double>(row.size[1]);
    const double c = static_cast<double>(row.size[2]);
    switch (static_cast<ShapeKind>(row.kind)) {
        case ShapeKind::sphere:
            return std::hypot(p.x, p.y, p.z) - a;
        case ShapeKind::box:
            return std::max({std::abs(p.x) - a, std::abs(p.y) - b, std::abs(p.z) - c});
        case ShapeKind::frustum:
            return side_of_cone(p, a, b, c);
        case ShapeKind::capsule:
            return side_of_capsule(p, a, b, c);
        case ShapeKind::plane:
        case ShapeKind::disk:
            return p.y;
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return side_of_quadric(row.k, p);
}

FormulaCheck check_formulas(const TrueScene& scene, uint64_t segments, uint64_t seed) {
    if (scene.item_count() == 0) return {};
    std::atomic<uint64_t> wrong = 0;
    parallel_ranges(static_cast<size_t>(segments), block_size, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            RandomStream random(i ^ (seed << 40));
            const Item item = scene.item(random.below(scene.item_count()));
            const bool right = scene.is_triangle(item)
                                   ? is_triangle_right(scene.triangle(item), random)
                                   : is_shape_right(scene.shape(item), random);
            if (!right) wrong.fetch_add(1, std::memory_order_relaxed);
        }
    });
    return {segments, wrong.load()};
}

}  // namespace obscura
