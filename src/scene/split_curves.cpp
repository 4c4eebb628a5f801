// scene/split_curves.cpp - gives lines a point of their own where they pass a surface.
// SPDX-License-Identifier: Apache-2.0
#include "scene/split_curves.h"

#include <algorithm>

namespace obscura {

namespace {

using Side = std::function<double(const Vec3d& place_m)>;

/// A place between two points: `share` of the way from `first` to the next one.
struct Vertex {
    uint32_t first = 0;
    double share = 0;
};

double mix(double a, double b, double share) {
    return a + (b - a) * share;
}

/// The points and pieces of all lines, made anew.
class CurveSplitter {
public:
    CurveSplitter(Scene& scene, const Side& side) : scene_(scene), side_(side) {}

    void run() {
        for (Primitive& primitive : scene_.primitives) {
            if (primitive.geometry == static_cast<int32_t>(GeometryKind::curves)) split(primitive);
        }
        scene_.curve_points = std::move(points_);
        scene_.curve_segments = std::move(segments_);
    }

private:
    double side_of(uint32_t point) const {
        const float* p = &scene_.curve_points[size_t{point} * 4];
        return side_({p[0], p[1], p[2]});
    }

    void add_point(const Vertex& vertex) {
        const float* p = &scene_.curve_points[size_t{vertex.first} * 4];
        for (size_t c = 0; c < 4; ++c) {
            const double value = vertex.share > 0 ? mix(p[c], p[c + 4], vertex.share) : p[c];
            points_.push_back(static_cast<float>(value));
        }
        vertices_.push_back(vertex);
    }

    void add_segment(const Vertex& to) {
        segments_.push_back(static_cast<uint32_t>(points_.size() / 4 - 1));
        add_point(to);
    }

    void add_colors(Primitive& primitive, size_t first_point) {
        if (primitive.color_base == no_attribute) return;
        std::vector<float>& all = scene_.attributes;
        const int64_t old_base = primitive.color_base;
        const auto base = static_cast<int64_t>(all.size()) - static_cast<int64_t>(first_point * 4);
        for (const Vertex& vertex : vertices_) {
            const auto at = static_cast<size_t>(old_base + int64_t{vertex.first} * 4);
            for (size_t c = 0; c < 4; ++c) {
                const double next = vertex.share > 0 ? all[at + c + 4] : all[at + c];
                all.push_back(static_cast<float>(mix(all[at + c], next, vertex.share)));
            }
        }
        primitive.color_base = static_cast<int32_t>(base);
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
            const double here = side_of(from);
            const double there = side_of(from + 1);
            if (here * there < 0) add_segment({from, here / (here - there)});
            add_segment({from + 1, 0});
        }
        primitive.first_triangle = static_cast<int32_t>(first_segment);
        primitive.triangle_count = static_cast<int32_t>(segments_.size() - first_segment);
        add_colors(primitive, first_point);
    }

    Scene& scene_;
    const Side& side_;
    std::vector<float> points_;
    std::vector<uint32_t> segments_;
    std::vector<Vertex> vertices_;  ///< of one primitive's points, in the old table
};

}  // namespace

void split_curves(Scene& scene, const Side& side) {
    bool crosses = false;
    const auto side_at = [&](size_t point) {
        const float* p = &scene.curve_points[point * 4];
        return side({p[0], p[1], p[2]});
    };
    for (const uint32_t from : scene.curve_segments)
        crosses = crosses || side_at(from) * side_at(size_t{from} + 1) < 0;
    if (crosses) CurveSplitter(scene, side).run();
}

}  // namespace obscura
