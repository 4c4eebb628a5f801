// scene/split_curves.cpp - splits curve segments that cross a surface or are very long.
// SPDX-License-Identifier: Apache-2.0
#include "scene/split_curves.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// Parameters in (0, 1), rising, at which a curve segment is cut. ends: the two records of
/// Scene::curve_points.
using Cuts = std::function<std::vector<double>(const float* ends)>;

Vec3d position(const float* point) {
    return {point[0], point[1], point[2]};
}

/// A point between `first` and the next curve point, at the parameter `fraction`.
struct Vertex {
    uint32_t first = 0;
    double fraction = 0;
};

double mix(double a, double b, double fraction) {
    return a + (b - a) * fraction;
}

/// Rebuilds the points and segments of all curves.
class CurveSplitter {
public:
    CurveSplitter(Scene& scene, const Cuts& cuts) : scene_(scene), cuts_(cuts) {}

    void run() {
        for (Primitive& primitive : scene_.primitives) {
            if (primitive.geometry == static_cast<int32_t>(GeometryKind::curves)) split(primitive);
        }
        scene_.attributes.resize(scene_.attributes.size() + 1, 0.0f);  // normals are read in fours
        scene_.curve_points = std::move(points_);
        scene_.curve_segments = std::move(segments_);
    }

private:
    void add_point(const Vertex& vertex) {
        const float* p = &scene_.curve_points[size_t{vertex.first} * 4];
        for (size_t c = 0; c < 4; ++c) {
            const double value = vertex.fraction > 0 ? mix(p[c], p[c + 4], vertex.fraction) : p[c];
            points_.push_back(static_cast<float>(value));
        }
        vertices_.push_back(vertex);
    }

    void add_segment(const Vertex& to) {
        segments_.push_back(static_cast<uint32_t>(points_.size() / 4 - 1));
        add_point(to);
    }

    /// Rewrites an attribute of `width` floats per vertex, for the points from `first` on.
    void split_attribute(int32_t& base, size_t width, size_t first) {
        if (base == no_attribute) return;
        LargeArray<float>& all = scene_.attributes;
        const int64_t old_base = base;
        base = static_cast<int32_t>(static_cast<int64_t>(all.size()) -
                                    static_cast<int64_t>(first * width));
        for (const Vertex& vertex : vertices_) {
            const auto at =
                static_cast<size_t>(old_base + int64_t{vertex.first} * static_cast<int64_t>(width));
            for (size_t c = 0; c < width; ++c) {
                const double next = vertex.fraction > 0 ? all[at + c + width] : all[at + c];
                all.push_back(static_cast<float>(mix(all[at + c], next, vertex.fraction)));
            }
        }
    }

    void split(Primitive& primitive) {
        vertices_.clear();
        const size_t first_point = points_.size() / 4;
        const auto begin = static_cast<size_t>(primitive.first_triangle);
        const size_t end = begin + static_cast<size_t>(primitive.triangle_count);
        const size_t first_segment = segments_.size();
        for (size_t i = begin; i < end; ++i) {
            const uint32_t from = scene_.curve_segments[i];
            const bool goes_on = i > begin && scene_.curve_segments[i - 1] + 1 == from;
            if (!goes_on) add_point({from, 0});
            for (const double fraction : cuts_(&scene_.curve_points[size_t{from} * 4]))
                add_segment({from, fraction});
            add_segment({from + 1, 0});
        }
        primitive.first_triangle = static_cast<int32_t>(first_segment);
        primitive.triangle_count = static_cast<int32_t>(segments_.size() - first_segment);
        split_attribute(primitive.color_base, 4, first_point);
        split_attribute(primitive.normal_base, 3, first_point);
        for (int32_t& base : primitive.uv_base)
            split_attribute(base, 2, first_point);
    }

    Scene& scene_;
    const Cuts& cuts_;
    std::vector<float> points_;
    std::vector<uint32_t> segments_;
    std::vector<Vertex> vertices_;  ///< of one primitive's points, in the old table
};

void split(Scene& scene, const Cuts& cuts) {
    const bool any =
        std::any_of(scene.curve_segments.begin(), scene.curve_segments.end(), [&](uint32_t from) {
            return !cuts(&scene.curve_points[size_t{from} * 4]).empty();
        });
    if (any) CurveSplitter(scene, cuts).run();
}

}  // namespace

void split_curves(Scene& scene, const std::function<double(const Vec3d& position_m)>& side) {
    split(scene, [&](const float* ends) -> std::vector<double> {
        const double here = side(position(ends));
        const double there = side(position(ends + 4));
        if (here * there >= 0) return {};
        return {here / (here - there)};
    });
}

void split_long_curves(Scene& scene) {
    // Squares of half the length round by 2^-22 of themselves: this is 1 % of the radius' square.
    constexpr double longest = 400;  // in radii
    constexpr double max_segments = 64;
    split(scene, [&](const float* ends) {
        const auto radius = static_cast<double>(std::min(ends[3], ends[7]));
        const double wanted = length(position(ends + 4) - position(ends)) / (radius * longest);
        const int segments = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, max_segments));
        std::vector<double> fractions;
        for (int i = 1; i < segments; ++i)
            fractions.push_back(static_cast<double>(i) / segments);
        return fractions;
    });
}

}  // namespace obscura
