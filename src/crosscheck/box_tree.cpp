// crosscheck/box_tree.cpp - a tree of boxes in double.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace obscura {

namespace {

constexpr int32_t leaf_size = 4;

double component(const Vec3d& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

Vec3d smaller(const Vec3d& a, const Vec3d& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

/// 1 / d; a huge number for 0, so that 0 times it is no NaN.
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

BoxRay::BoxRay(const TrueRay& ray)
    : origin_(ray.origin),
      inverse_{safe_inverse(ray.direction.x),
               safe_inverse(ray.direction.y),
               safe_inverse(ray.direction.z)} {}

bool BoxRay::meets(const TrueBox& box, double limit) const {
    const Vec3d a = (box.low - origin_) * inverse_;
    const Vec3d b = (box.high - origin_) * inverse_;
    const Vec3d in = smaller(a, b);
    const Vec3d out = max3(a, b);
    const double enter = max_component(in);
    const double leave = std::min({out.x, out.y, out.z});
    constexpr double slack = 1e-12;
    return leave >= 0 && enter <= leave + slack * leave && enter <= limit + slack * limit;
}

BoxTree::BoxTree(const std::vector<TrueBox>& boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.reserve(boxes.size());
    nodes_.emplace_back();
    split(0, boxes, 0, static_cast<int32_t>(boxes.size()));
}

void BoxTree::split(size_t node, const std::vector<TrueBox>& boxes, int32_t begin, int32_t end) {
    TrueBox all;
    TrueBox centres;
    const auto centre = [&](int32_t item) {
        const TrueBox& box = boxes[static_cast<size_t>(item)];
        return (box.low + box.high) * 0.5;
    };
    for (int32_t i = begin; i < end; ++i) {
        const int32_t item = order_[static_cast<size_t>(i)];
        all.add(boxes[static_cast<size_t>(item)]);
        centres.add(centre(item));
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
    const auto at = [&](int32_t i) { return order_.begin() + i; };
    std::nth_element(at(begin), at(middle), at(end), [&](int32_t a, int32_t b) {
        return component(centre(a), axis) < component(centre(b), axis);
    });
    const size_t child = nodes_.size();
    nodes_.resize(child + 2);
    nodes_[node].first = static_cast<int32_t>(child);
    nodes_[node].axis = axis;
    split(child, boxes, begin, middle);
    split(child + 1, boxes, middle, end);
}

}  // namespace obscura
