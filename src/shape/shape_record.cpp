// shape/shape_record.cpp - bounding boxes of shapes, and shapes under scale and translation.
// SPDX-License-Identifier: Apache-2.0
#include "shape/shape_record.h"

#include "shape/sphere_block.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

/// Half edges of the bounding box, about the centre. A capsule's longer end counts for both.
Vec3d half_extent(const ShapeRecord& record) {
    const double a = static_cast<double>(record.size[0]);
    const double b = static_cast<double>(record.size[1]);
    const double c = static_cast<double>(record.size[2]);
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            return {a, a, a};
        case ShapeKind::frustum:
            return {std::max(b, c), a, std::max(b, c)};
        case ShapeKind::capsule:
            return {std::max(b, c), a + std::max(b, c), std::max(b, c)};
        case ShapeKind::plane:
            return {a, 0, b};
        case ShapeKind::disk:
            return {a, 0, a};
        case ShapeKind::box:
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return {a, b, c};
}

}  // namespace

ShapeBox shape_bounds(const ShapeRecord& record) {
    const Vec3d half = half_extent(record);
    const double largest = max_component(half);
    const auto low = [&](float centre, double extent) {
        if (extent >= static_cast<double>(unbounded)) return -INFINITY;
        const double c = static_cast<double>(centre);
        return static_cast<float>(c - extent - 1e-6 * (largest + std::abs(c)));
    };
    const auto high = [&](float centre, double extent) { return -low(-centre, extent); };
    const float* c = record.centre;
    const bool infinite = is_unbounded(record);
    const auto y_low = infinite ? c[1] : low(c[1], half.y);
    const auto y_high = infinite ? c[1] : high(c[1], half.y);
    return {{low(c[0], half.x), y_low, low(c[2], half.z)},
            {high(c[0], half.x), y_high, high(c[2], half.z)}};
}

ShapeBox sphere_block_bounds(const float* block) {
    ShapeBox box{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < sphere_block; ++i) {
        ShapeRecord record;
        record.size[0] = block[3 * sphere_block + i];
        if (!(record.size[0] >= 0)) continue;
        for (int c = 0; c < 3; ++c)
            record.centre[c] = block[c * sphere_block + i];
        const ShapeBox one = shape_bounds(record);
        box.low = {std::min(box.low.x, one.low.x),
                   std::min(box.low.y, one.low.y),
                   std::min(box.low.z, one.low.z)};
        box.high = max3(box.high, one.high);
    }
    return box;
}

ShapeRecord scaled_and_moved(const ShapeRecord& record, double scale, const Vec3d& move) {
    ShapeRecord out = record;
    const double offset[3] = {move.x, move.y, move.z};
    for (int i = 0; i < 3; ++i) {
        out.centre[i] =
            static_cast<float>(scale * static_cast<double>(record.centre[i]) + offset[i]);
        if (record.size[i] < unbounded) {
            out.size[i] = static_cast<float>(scale * static_cast<double>(record.size[i]));
        }
    }
    // Q(p / s) * s^2: the quadratic terms stay, the linear ones grow with s, the constant with s^2.
    for (int i = 6; i < 9; ++i)
        out.k[i] = static_cast<float>(scale * static_cast<double>(record.k[i]));
    out.k[9] = static_cast<float>(scale * scale * static_cast<double>(record.k[9]));
    return out;
}

}  // namespace obscura
