// tests/shape/shape_truth.h - sample shapes, rays at them, and their insides by definition.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/shape_record.h"

#include "support/random.h"
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace obscura::test {

inline ShapeRecord shape_record(ShapeKind kind, float a, float b, float c) {
    ShapeRecord record;
    record.kind = static_cast<int32_t>(kind);
    record.size[0] = a;
    record.size[1] = b;
    record.size[2] = c;
    return record;
}

inline ShapeRecord quadric_record(const float (&k)[10], float x, float y, float z) {
    ShapeRecord record = shape_record(ShapeKind::quadric, x, y, z);
    std::copy_n(k, 10, record.k);
    return record;
}

inline ShapeRecord moved(ShapeRecord record, float x, float y, float z) {
    return scaled_and_moved(record, 1, {x, y, z});
}

struct NamedShape {
    std::string name;
    ShapeRecord record;
    bool solid;  ///< encloses a volume: its inside is defined
};

/// One of each kind and of each special case; a few away from the origin.
inline std::vector<NamedShape> sample_shapes() {
    const ShapeRecord cone = shape_record(ShapeKind::frustum, 1.0F, 0.8F, 0.0F);
    const float ellipsoid[10] = {1.0F, 4.0F, 2.0F, 0.3F, 0, 0.2F, 0.1F, 0, 0, -1};
    const float hyperboloid[10] = {1, -1, 1, 0, 0, 0, 0, 0, 0, -0.2F};
    const float two_sheets[10] = {1, -1, 1, 0, 0, 0, 0, 0, 0, 0.1F};
    const float paraboloid[10] = {1, 0, 1, 0, 0, 0, 0, -1, 0, -0.5F};
    const float saddle[10] = {1, 0, -1, 0, 0, 0, 0, -1, 0, 0};
    const float planes[10] = {1, 0, 0, 0, 0, 0, 0, 0, 0, -0.25F};
    return {{"sphere", shape_record(ShapeKind::sphere, 1, 0, 0), true},
            {"moved sphere", moved(shape_record(ShapeKind::sphere, 0.7F, 0, 0), 3, -2, 1.5F), true},
            {"box", shape_record(ShapeKind::box, 1, 0.5F, 0.25F), true},
            {"cylinder", shape_record(ShapeKind::frustum, 0.7F, 0.5F, 0.5F), true},
            {"cone", cone, true},
            {"moved cone", moved(cone, -1, 5, 2), true},
            {"frustum", shape_record(ShapeKind::frustum, 0.4F, 0.3F, 0.9F), true},
            {"capsule", shape_record(ShapeKind::capsule, 0.6F, 0.4F, 0.4F), true},
            {"uneven capsule", shape_record(ShapeKind::capsule, 0.6F, 0.2F, 0.8F), true},
            {"rectangle", shape_record(ShapeKind::plane, 1, 0.6F, 0), false},
            {"disk", shape_record(ShapeKind::disk, 1, 0, 0), false},
            {"ring", shape_record(ShapeKind::disk, 1, 0.4F, 0), false},
            {"ellipsoid", quadric_record(ellipsoid, 1.2F, 1.2F, 1.2F), true},
            {"hyperboloid of one sheet", quadric_record(hyperboloid, 1, 1, 1), false},
            {"hyperboloid of two sheets", quadric_record(two_sheets, 1, 1, 1), false},
            {"paraboloid", quadric_record(paraboloid, 1, 0.5F, 1), false},
            {"saddle", quadric_record(saddle, 1, 1, 1), false},
            {"pair of planes", quadric_record(planes, 1, 1, 1), false}};
}

/// Negative inside, positive outside, zero on the surface: by definition, without a ray formula.
inline double implicit_value(const ShapeRecord& record, const Vec3d& point) {
    const Vec3d p = point - Vec3d{record.centre[0], record.centre[1], record.centre[2]};
    const double a = static_cast<double>(record.size[0]);
    const double b = static_cast<double>(record.size[1]);
    const double c = static_cast<double>(record.size[2]);
    const double around = std::hypot(p.x, p.z);
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            return length(p) - a;
        case ShapeKind::box:
            return std::max({std::abs(p.x) - a, std::abs(p.y) - b, std::abs(p.z) - c});
        case ShapeKind::frustum:
            return std::max(std::abs(p.y) - a,
                            (around - (b + (c - b) * (p.y + a) / (2 * a))) /
                                std::hypot(1.0, (c - b) / (2 * a)));
        case ShapeKind::capsule: {
            // The hull of two spheres is the union of all spheres between them.
            double least = 1e30;
            for (int pass = 0, best = 0; pass < 3; ++pass) {
                const double width = pass == 0 ? 1.0 : pass == 1 ? 0.02 : 0.0004;
                const double middle = pass == 0 ? 0.5 : best * 1e-6;
                for (int i = 0; i <= 100; ++i) {
                    const double s = std::clamp(middle + (i * 0.01 - 0.5) * width, 0.0, 1.0);
                    const double value =
                        length(p - Vec3d{0, a * (2 * s - 1), 0}) - (b + (c - b) * s);
                    if (value < least) {
                        least = value;
                        best = static_cast<int>(std::lround(s * 1e6));
                    }
                }
            }
            return least;
        }
        case ShapeKind::plane:
        case ShapeKind::disk:
            return p.y;
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return quadric_value(read_quadric<double>(UniformShape<double>(record)), p);
}

/// True where a point is within the part of the surface that exists.
inline bool within_limits(const ShapeRecord& record, const Vec3d& point, double slack) {
    const Vec3d p = point - Vec3d{record.centre[0], record.centre[1], record.centre[2]};
    const double a = static_cast<double>(record.size[0]);
    const double b = static_cast<double>(record.size[1]);
    const double c = static_cast<double>(record.size[2]);
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::plane:
            return std::abs(p.x) <= a + slack && std::abs(p.z) <= b + slack;
        case ShapeKind::disk:
            return std::hypot(p.x, p.z) <= a + slack && std::hypot(p.x, p.z) >= b - slack;
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            return std::abs(p.x) <= a + slack && std::abs(p.y) <= b + slack &&
                   std::abs(p.z) <= c + slack;
        default:
            return true;
    }
}

template <typename To, typename From>
ShapeRay<To> ray_cast_to(const ShapeRay<From>& ray) {
    const auto cast = [](const Vec3<From>& v) {
        return Vec3<To>{static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
    };
    return {cast(ray.origin), cast(ray.direction)};
}

/// A ray at a shape from `distance` times its size away; 0 begins inside or close by.
inline ShapeRay<float> random_ray(const ShapeRecord& record, float distance, Pcg32& random) {
    const auto unit = [&] {
        const float x = random.next_float();
        return uniform_sphere(Vec2f{x, random.next_float()});
    };
    const Vec3f centre{record.centre[0], record.centre[1], record.centre[2]};
    const float reach = 1.3F * random.next_float();
    const Vec3f target = centre + unit() * reach;
    const Vec3f origin = distance > 0 ? centre + unit() * distance : centre + unit() * reach;
    const float size = std::exp2(4.0F * random.next_float() - 2.0F);
    const Vec3f direction = distance > 0 ? normalize(target - origin) : unit();
    return {origin, direction * size};
}

}  // namespace obscura::test
