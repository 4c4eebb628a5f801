// light/light_tree.cpp - builds the light tree by the surface area orientation heuristic.
// SPDX-License-Identifier: Apache-2.0
#include "light/light_tree.h"

#include "base/parallel.h"
#include "light/direction_cone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace obscura {
namespace {

constexpr int bins = 12;

/// A radius with what rounding may have taken from it and from the centre, which lies in the box.
float with_slack(float radius, const Vec3f& low, const Vec3f& high) {
    const float coordinate = max_component(max3(abs(low), abs(high)));
    return radius * (1.0f + 1e-5f) + coordinate * 0x1p-22f;
}

/// The least of all intensities that a light counts with: less would underflow far away.
constexpr double min_share = 1e-20;

/// Bounds of several lights, while they are collected.
struct Cluster {
    Vec3f low{INFINITY, INFINITY, INFINITY};
    Vec3f high{-INFINITY, -INFINITY, -INFINITY};
    DirectionCone normals;
    float emission_angle = 0;
    double intensity = 0;
    bool two_sided = false;
    size_t count = 0;
};

Cluster cluster_of(const BoundedLight& light) {
    const LightBounds& b = light.bounds;
    const float half_angle = std::atan2(b.sin_normals, b.cos_normals);
    return {light.low,
            light.high,
            {{b.axis[0], b.axis[1], b.axis[2]}, half_angle},
            std::acos(b.cos_emission),
            static_cast<double>(b.intensity),
            (b.sides & 1) != 0,
            1};
}

Cluster join(const Cluster& a, const Cluster& b) {
    if (a.count == 0) return b;
    if (b.count == 0) return a;
    DirectionCone other = b.normals;
    // The normals of a light that shines to both sides may be taken the other way round.
    if (b.two_sided && dot(a.normals.axis, other.axis) < 0) other.axis = -other.axis;
    DirectionCone own = a.normals;
    if (!b.two_sided && a.two_sided && dot(own.axis, other.axis) < 0) own.axis = -own.axis;
    return {-max3(-a.low, -b.low),
            max3(a.high, b.high),
            join(own, other),
            std::max(a.emission_angle, b.emission_angle),
            a.intensity + b.intensity,
            a.two_sided || b.two_sided,
            a.count + b.count};
}

/// The measure of the directions in which lights emit, weighted by the cosine to their normals.
/// Source  Conty Estevez and Kulla 2018, equation 1
double orientation_measure(const Cluster& c) {
    const auto normals = static_cast<double>(c.normals.half_angle);
    const double all = std::min(normals + static_cast<double>(c.emission_angle), pi_d);
    const double beyond = 2 * all * std::sin(normals) - std::cos(normals - 2 * all) -
                          2 * normals * std::sin(normals) + std::cos(normals);
    const double one_side = 2 * pi_d * (1 - std::cos(normals)) + pi_d / 2 * beyond;
    return c.two_sided ? 2 * one_side : one_side;
}

/// Weighted like an area: the square of the box's diagonal, which is above 0 for lights in a line.
double cost_of(const Cluster& c) {
    if (c.count == 0) return 0;
    const Vec3f size = c.high - c.low;
    return c.intensity * static_cast<double>(dot(size, size)) * orientation_measure(c);
}

float component(const Vec3f& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// A part of the tree, its lights taken together.
struct Summary {
    Cluster cluster;
    LightBounds bounds;
};

Summary join(const Summary& left, const Summary& right) {
    Summary out{join(left.cluster, right.cluster), {}};
    const Cluster& c = out.cluster;
    LightBounds& b = out.bounds;
    const Vec3f centre = (c.low + c.high) * 0.5f;
    const auto reach = [&](const LightBounds& child) {
        const Vec3f at{child.centre[0], child.centre[1], child.centre[2]};
        return length(at - centre) + child.radius;
    };
    const float corner = 0.5f * length(c.high - c.low);
    const float radius = std::min(corner, std::max(reach(left.bounds), reach(right.bounds)));
    b.radius = with_slack(radius, c.low, c.high);
    std::copy_n(&centre.x, 3, b.centre);
    std::copy_n(&c.normals.axis.x, 3, b.axis);
    const bool all = c.normals.half_angle >= pi_f;
    b.cos_normals = all ? -1.0f : std::cos(c.normals.half_angle);
    b.sin_normals = all ? 0.0f : std::sin(c.normals.half_angle);
    b.cos_emission = std::cos(c.emission_angle);
    b.intensity = static_cast<float>(c.intensity);
    b.sides = c.two_sided ? 1 : 0;
    return out;
}

/// Lights [first, end) of the order, which become one subtree.
struct Subtree {
    size_t first, end;
    size_t node;  ///< its first
    size_t size() const { return end - first; }
};

/// A cut between two bins of one axis.
struct Cut {
    int axis = -1;
    int last_left = 0;  ///< bin
    float low = 0, scale = 0;
    double cost = std::numeric_limits<double>::infinity();

    int bin_of(const Vec3f& centre) const {
        const float place = (component(centre, axis) - low) * scale;
        return std::clamp(static_cast<int>(place), 0, bins - 1);
    }
};

class Builder {
public:
    explicit Builder(std::span<const BoundedLight> lights);

    /// Level by level: the subtrees of a level share nothing.
    void build();

    std::vector<LightTreeNode> nodes;
    std::vector<int32_t> order;  ///< of the lights, by leaf

private:
    /// In      cut: its axis, with `low' and `scale' of the lights' centres
    void try_axis(const Subtree& tree, const Cut& cut, double regularity, Cut& best) const;
    Cut best_cut(const Subtree& tree) const;
    std::array<Subtree, 2> split(const Subtree& tree);
    void finish(size_t node);
    Summary summary_of(size_t first, size_t end, size_t node) const {
        return end - first == 1 ? leaves_[static_cast<size_t>(order[first])] : summaries_[node];
    }
    Vec3f centre_of(int32_t light) const {
        const Cluster& c = leaves_[static_cast<size_t>(light)].cluster;
        return (c.low + c.high) * 0.5f;
    }

    struct Range {
        size_t first, middle, end;
    };

    std::vector<Summary> leaves_;     ///< by index of the lights
    std::vector<Summary> summaries_;  ///< by node
    std::vector<Range> ranges_;       ///< by node: the leaves of its children
};

Builder::Builder(std::span<const BoundedLight> lights) {
    const size_t inner = lights.size() - 1;
    nodes.resize(inner);
    summaries_.resize(inner);
    ranges_.resize(inner);
    double total = 0;
    for (const BoundedLight& light : lights)
        total += static_cast<double>(light.bounds.intensity);
    order.resize(lights.size());
    std::iota(order.begin(), order.end(), 0);
    for (const BoundedLight& light : lights) {
        leaves_.push_back({cluster_of(light), light.bounds});
        Summary& leaf = leaves_.back();
        leaf.cluster.intensity = std::max(leaf.cluster.intensity / total, min_share);
        leaf.bounds.intensity = static_cast<float>(leaf.cluster.intensity);
        leaf.bounds.radius = with_slack(leaf.bounds.radius, light.low, light.high);
    }
}

void Builder::build() {
    std::vector<Subtree> level{{0, order.size(), 0}};
    while (!level.empty()) {
        std::vector<std::array<Subtree, 2>> children(level.size());
        parallel_for(level.size(), [&](size_t i) { children[i] = split(level[i]); });
        level.clear();
        for (const auto& pair : children) {
            std::copy_if(pair.begin(), pair.end(), std::back_inserter(level), [](const auto& t) {
                return t.size() > 1;
            });
        }
    }
    // Children have higher numbers than their parents.
    for (size_t node = nodes.size(); node-- > 0;)
        finish(node);
}

void Builder::try_axis(const Subtree& tree, const Cut& cut, double regularity, Cut& best) const {
    std::array<Cluster, bins> in_bin;
    for (size_t i = tree.first; i < tree.end; ++i) {
        Cluster& c = in_bin[static_cast<size_t>(cut.bin_of(centre_of(order[i])))];
        c = join(c, leaves_[static_cast<size_t>(order[i])].cluster);
    }
    std::array<double, bins> right_cost{};
    Cluster right;
    for (size_t b = bins - 1; b > 0; --b) {
        right = join(in_bin[b], right);
        right_cost[b] = cost_of(right);
    }
    Cluster left;
    for (size_t b = 0; b + 1 < bins; ++b) {
        left = join(left, in_bin[b]);
        const double cost = regularity * (cost_of(left) + right_cost[b + 1]);
        if (left.count == 0 || left.count == tree.size() || !(cost < best.cost)) continue;
        best = cut;
        best.last_left = static_cast<int>(b);
        best.cost = cost;
    }
}

Cut Builder::best_cut(const Subtree& tree) const {
    Vec3f low{INFINITY, INFINITY, INFINITY};
    Vec3f high = -low;
    for (size_t i = tree.first; i < tree.end; ++i) {
        const Vec3f centre = centre_of(order[i]);
        low = -max3(-low, -centre);
        high = max3(high, centre);
    }
    const Vec3f size = high - low;
    const float longest = max_component(size);
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
        const float along = component(size, axis);
        if (!(along > 1e-6f * longest)) continue;
        const Cut cut{
            .axis = axis, .low = component(low, axis), .scale = static_cast<float>(bins) / along};
        try_axis(tree, cut, static_cast<double>(longest / along), best);
    }
    return best;
}

std::array<Subtree, 2> Builder::split(const Subtree& tree) {
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(tree.first);
    size_t left = tree.size() / 2;  // of lights with one centre
    const Cut best = tree.size() > 2 ? best_cut(tree) : Cut();
    if (best.axis >= 0) {
        const auto end = begin + static_cast<std::ptrdiff_t>(tree.size());
        const auto cut = std::stable_partition(begin, end, [&](int32_t light) {
            return best.bin_of(centre_of(light)) <= best.last_left;
        });
        left = static_cast<size_t>(cut - begin);
    }
    const size_t middle = tree.first + left;
    ranges_[tree.node] = {tree.first, middle, tree.end};
    return {Subtree{tree.first, middle, tree.node + 1},
            Subtree{middle, tree.end, tree.node + left}};
}

void Builder::finish(size_t node) {
    const auto [first, middle, end] = ranges_[node];
    const Summary left = summary_of(first, middle, node + 1);
    const Summary right = summary_of(middle, end, node + middle - first);
    summaries_[node] = join(left, right);
    nodes[node] = {left.bounds, right.bounds};
    nodes[node].right.sides += 2 * static_cast<int32_t>(middle);
}

}  // namespace

LightTree build_light_tree(std::span<const BoundedLight> lights, size_t light_count) {
    Builder builder(lights);
    builder.build();
    LightTree tree{std::move(builder.nodes), {}, std::vector<int32_t>(light_count, -1)};
    for (const int32_t index : builder.order) {
        const int32_t light = lights[static_cast<size_t>(index)].light;
        tree.leaf_of_light[static_cast<size_t>(light)] =
            static_cast<int32_t>(tree.light_of_leaf.size());
        tree.light_of_leaf.push_back(light);
    }
    return tree;
}

}  // namespace obscura
