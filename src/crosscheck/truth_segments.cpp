// crosscheck/truth_segments.cpp - line segments in double precision.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/shape_side.h"
#include "crosscheck/truth.h"

#include <algorithm>

namespace obscura::crosscheck {

namespace {

/// Two spheres; one may hold the other only as far as the renderer lets it.
struct Hull {
    Vec3d middle[2];
    double radius[2];

    explicit Hull(const Segment<double>& segment)
        : middle{segment.from, segment.to}, radius{segment.radius_from, segment.radius_to} {
        const double most = 0.99 * length(segment.to - segment.from);
        radius[0] = std::min(segment.radius_from, segment.radius_to + most);
        radius[1] = std::min(segment.radius_to, segment.radius_from + most);
    }
};

}  // namespace

bool TrueScene::is_segment(const Item& item) const {
    const Primitive& primitive = scene_.primitives[static_cast<size_t>(item.primitive)];
    return primitive.geometry == static_cast<int32_t>(GeometryKind::curves);
}

int64_t TrueScene::curve_point(const Item& item) const {
    const Primitive& primitive = scene_.primitives[static_cast<size_t>(item.primitive)];
    const int32_t index = primitive.first_triangle + item.element;
    return scene_.curve_segments[static_cast<size_t>(index)];
}

Segment<double> TrueScene::segment(const Item& item) const {
    const float* p = &scene_.curve_points[4 * static_cast<size_t>(curve_point(item))];
    return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}, p[3], p[7]};
}

SegmentFrame<double> TrueScene::curve_frame(const Item& item) const {
    return frame_of(segment(item));
}

std::optional<Item> TrueScene::next_segment(const Item& item, int32_t step) const {
    const Primitive& primitive = scene_.primitives[static_cast<size_t>(item.primitive)];
    const Item next{item.instance, item.primitive, item.element + step};
    if (next.element < 0 || next.element >= primitive.triangle_count) return {};
    if (curve_point(next) != curve_point(item) + step) return {};
    return next;
}

double TrueScene::side_of_segment(const Item& item, const Vec3d& place) const {
    const Hull hull(segment(item));
    return side_of_hull(hull.middle, hull.radius, place);
}

Crossings TrueScene::cross_segment(const Item& item, const TrueRay& ray) const {
    const Hull hull(segment(item));
    const Crossings all = cross_hull(hull.middle, hull.radius, ray);
    // The sphere between two segments belongs to both.
    const double inside = -1e-9 * (length(hull.middle[1] - hull.middle[0]) +
                                   std::max(hull.radius[0], hull.radius[1]));
    Crossings found;
    for (int k = 0; k < all.count; ++k) {
        const Vec3d place = ray.origin + ray.direction * all.t[k];
        const auto is_outside = [&](int32_t step) {
            const std::optional<Item> next = next_segment(item, step);
            return !next || side_of_segment(*next, place) >= inside;
        };
        if (is_outside(-1) && is_outside(1)) found.add(all.t[k]);
    }
    return found;
}

}  // namespace obscura::crosscheck
