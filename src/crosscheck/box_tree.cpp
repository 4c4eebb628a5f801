// crosscheck/box_tree.cpp - a tree of boxes in double.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/box_tree.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

constexpr int32_t leaf_size = 4;

double component(const Vec3d& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

Vec3d smaller(const Vec3d& a, const Vec3d& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

/// 1 / d; a huge number for 0, so that its product with 0 is no NaN.
double safe_inverse(double d) {
    return std::abs(d) < 1e-200 ? std::copysign(1e200, d) : 1 / d;
}

}  // namespace

void TrueBox::add(const Vec3d& p) {
    low = smaller(low, p);
    high = max3(high, p);
}

void TrueBox::add(const TrueBox& other) {
    low = smaller(low, other.low);
    high = max3(high, other.high);
}

TrueBox TrueBox::with_room() const {
    const double room = 1e-9 * max_component(max3(abs(low), abs(high)));
    return {low - Vec3d{room, room, room}, high + Vec3d{room, room, room}};
}

BoxRay::BoxRay(const TrueRay& ray, double room)
    : from_low_(ray.origin + splat3(room)),
      from_high_(ray.origin - splat3(room)),
      inverse_{safe_inverse(ray.direction.x),
               safe_inverse(ray.direction.y),
               safe_inverse(ray.direction.z)},
      backwards_{ray.direction.x < 0, ray.direction.y < 0, ray.direction.z < 0} {}

BoxTree::BoxTree(const std::vector<TrueBox>& boxes) {
    if (boxes.empty()) return;
    leaves_.reserve(boxes.size());
    for (const TrueBox& box : boxes)
        leaves_.push_back({box, static_cast<int32_t>(leaves_.size())});
    nodes_.reserve(boxes.size());
    nodes_.emplace_back();
    split(0, 0, static_cast<int32_t>(boxes.size()));
    for (Leaf& leaf : leaves_)
        leaf.box = leaf.box.with_room();
}

void BoxTree::split(size_t node, int32_t begin, int32_t end) {
    TrueBox all;
    TrueBox centres;
    const auto centre = [](const Leaf& leaf) { return (leaf.box.low + leaf.box.high) * 0.5; };
    for (int32_t i = begin; i < end; ++i) {
        const Leaf& leaf = leaves_[static_cast<size_t>(i)];
        all.add(leaf.box);
        centres.add(centre(leaf));
    }
    nodes_[node].box = all.with_room();
    if (end - begin <= leaf_size) {
        nodes_[node].first = begin;
        nodes_[node].count = end - begin;
        return;
    }
    const Vec3d size = centres.high - centres.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int32_t middle = begin + (end - begin) / 2;
    const auto at = [&](int32_t i) { return leaves_.begin() + i; };
    std::nth_element(at(begin), at(middle), at(end), [&](const Leaf& a, const Leaf& b) {
        return component(centre(a), axis) < component(centre(b), axis);
    });
    const size_t child = nodes_.size();
    nodes_.resize(child + 2);
    nodes_[node].first = static_cast<int32_t>(child);
    nodes_[node].axis = axis;
    split(child, begin, middle);
    split(child + 1, middle, end);
}

}  // namespace obscura::crosscheck
