// crosscheck/shape_side.cpp - on which side of a shape a point lies, by definition.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/shape_side.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura::crosscheck {

namespace {

/// Distance from the axis less the radius at that height.
double side_of_cone(const Vec3d& p, const Vec3d& size) {
    const double fraction = (p.y + size.x) / (2 * size.x);
    const double radius = size.y + (size.z - size.y) * fraction;
    return std::max(std::sqrt(p.x * p.x + p.z * p.z) - radius, std::abs(p.y) - size.x);
}

/// A capsule is the union of spheres around all points of its axis, their radii interpolated: the
/// distance to the closest one, by a search over the axis, along which it is convex.
double side_of_capsule(const Vec3d& p, const Vec3d& size) {
    const auto side = [&](double fraction) {
        const double y = size.x * (2 * fraction - 1);
        return std::hypot(p.x, p.y - y, p.z) - (size.y + (size.z - size.y) * fraction);
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

std::array<double, 10> monomials(const Vec3d& p) {
    return {p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.x * p.z, p.y * p.z, p.x, p.y, p.z, 1};
}

double side_of_quadric(const ShapeRecord& record, const Vec3d& p) {
    const std::array<double, 10> terms = monomials(p);
    double sum = 0;
    for (size_t i = 0; i < 10; ++i)
        sum += static_cast<double>(record.k[i]) * terms[i];
    return sum;
}

/// The steepest of the three second differences, as a vector: the one direction in which a squared
/// plane rises.
Vec3d bend_of_quadric(const ShapeRecord& record) {
    const float* k = record.k;
    const Vec3d rows[3] = {{2 * k[0], k[3], k[4]}, {k[3], 2 * k[1], k[5]}, {k[4], k[5], 2 * k[2]}};
    return *std::max_element(std::begin(rows), std::end(rows), [](const Vec3d& a, const Vec3d& b) {
        return dot(a, a) < dot(b, b);
    });
}

}  // namespace

double side_of_shape(const ShapeRecord& record, const Vec3d& point) {
    const Vec3d p = point - centre_of(record);
    const Vec3d size = size_of(record);
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) - size.x;
        case ShapeKind::box:
            return std::max(
                {std::abs(p.x) - size.x, std::abs(p.y) - size.y, std::abs(p.z) - size.z});
        case ShapeKind::frustum:
            return side_of_cone(p, size);
        case ShapeKind::capsule:
            return side_of_capsule(p, size);
        case ShapeKind::plane:
        case ShapeKind::disk:
            return p.y;
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return side_of_quadric(record, p);
}

double side_of_hull(const Vec3d (&middle)[2], const double (&radius)[2], const Vec3d& point) {
    const Vec3d way = middle[1] - middle[0];
    const double length_m = length(way);
    const auto from_cap = [&](size_t k) { return length(point - middle[k]) - radius[k]; };
    if (length_m <= std::abs(radius[0] - radius[1])) return std::min(from_cap(0), from_cap(1));
    const Vec3d from = point - middle[0];
    const double along = dot(from, way) / length_m;
    const double across = length(from - way * (along / length_m));
    const double sine = (radius[0] - radius[1]) / length_m;
    const double cosine = std::sqrt((1 - sine) * (1 + sine));
    const double height = cosine * along - sine * across;
    if (height < 0) return from_cap(0);
    if (height > cosine * length_m) return from_cap(1);
    return cosine * across + sine * along - radius[0];
}

double terms_of_quadric(const ShapeRecord& record, const Vec3d& point, size_t past) {
    const std::array<double, 10> terms = monomials(point);
    double sum = 0;
    for (size_t i = 0; i < past; ++i)
        sum += std::abs(static_cast<double>(record.k[i]) * terms[i]);
    return sum;
}

Vec3d normal_of_shape(const ShapeRecord& record, const Vec3d& point) {
    if (is_flat(record)) return {0, 1, 0};
    const ShapeBox box = shape_bounds(record);
    const Vec3f size = box.high - box.low;
    const Vec3d half = Vec3d{size.x, size.y, size.z} * 0.5;
    const double step = 1e-6 * max_component(half);
    const auto side = [&](const Vec3d& p) {
        if (record.kind != static_cast<int32_t>(ShapeKind::capsule))
            return side_of_shape(record, p);
        const Vec3d sizes = size_of(record);
        const Vec3d up{0, sizes.x, 0};
        return side_of_hull(
            {centre_of(record) - up, centre_of(record) + up}, {sizes.y, sizes.z}, p);
    };
    const auto slope = [&](const Vec3d& way) {
        return side(point + way * step) - side(point - way * step);
    };
    const Vec3d rise{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
    if (!is_quadric(record)) return length(rise) > 0 ? normalize(rise) : Vec3d{0, 1, 0};
    const double least = 1e-9 * step * terms_of_quadric(record, half, 6) / max_component(half);
    if (length(rise) > least) return normalize(rise);
    const Vec3d bend = bend_of_quadric(record);
    return length(bend) > 0 ? normalize(bend) : Vec3d{0, 1, 0};
}

}  // namespace obscura::crosscheck
