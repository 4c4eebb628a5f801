// crosscheck/box_tree.h - a box hierarchy in double precision that collects possible hits.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace obscura::crosscheck {

/// A ray in double. The direction need not have length 1.
struct TrueRay {
    Vec3d origin, direction;
    double end = INFINITY;  ///< largest t that counts
};

struct TrueBox {
    Vec3d low = {INFINITY, INFINITY, INFINITY};
    Vec3d high = {-INFINITY, -INFINITY, -INFINITY};

    void add(const Vec3d& p);
    void add(const TrueBox& other);
    /// Grown by 1e-9 of its largest coordinate: far more than rounding in double needs.
    TrueBox with_room() const;
};

/// A ray prepared for box tests; with `room`, boxes that it passes as closely as that are met, too.
class BoxRay {
public:
    explicit BoxRay(const TrueRay& ray, double room = 0);

    /// True when a part of [0, limit] may lie in the box, and wherever rounding leaves a doubt.
    bool meets(const TrueBox& box, double limit) const {
        const Vec3d a = (box.low - from_low_) * inverse_;
        const Vec3d b = (box.high - from_high_) * inverse_;
        const double enter = max(min(a.x, b.x), max(min(a.y, b.y), min(a.z, b.z)));
        const double leave = min(max(a.x, b.x), min(max(a.y, b.y), max(a.z, b.z)));
        constexpr double slack = 1e-12;
        return leave >= 0 && enter <= leave + slack * leave && enter <= limit + slack * limit;
    }
    bool goes_backwards(int axis) const { return backwards_[axis]; }

private:
    Vec3d from_low_, from_high_;  ///< the origin, moved by `room`
    Vec3d inverse_;
    bool backwards_[3];
};

/// Independent of Embree. Boxes are never smaller than their items, so an item that is not visited
/// is not hit. Nodes split at the median item: the depth is the logarithm of the size.
class BoxTree {
public:
    explicit BoxTree(const std::vector<TrueBox>& boxes);

    /// Calls visit(i) for every box that the ray may meet before `limit`, which visit may lower;
    /// with room, for every one that it may pass as closely as that.
    template <typename Visit>
    void visit(const TrueRay& ray, const double& limit, const Visit& visit, double room = 0) const {
        if (nodes_.empty()) return;
        const BoxRay boxed(ray, room);
        int32_t stack[64];
        int size = 0;
        stack[size++] = 0;
        while (size > 0) {
            const Node& node = nodes_[static_cast<size_t>(stack[--size])];
            if (!boxed.meets(node.box, limit)) continue;
            if (node.count > 0) {
                for (int32_t i = node.first; i < node.first + node.count; ++i) {
                    const Leaf& leaf = leaves_[static_cast<size_t>(i)];
                    if (boxed.meets(leaf.box, limit)) visit(leaf.item);
                }
                continue;
            }
            const bool backwards = boxed.goes_backwards(node.axis);
            stack[size++] = backwards ? node.first : node.first + 1;  // the far child waits
            stack[size++] = backwards ? node.first + 1 : node.first;
        }
    }

    TrueBox bounds() const { return nodes_.empty() ? TrueBox{} : nodes_.front().box; }

private:
    struct Node {
        TrueBox box;
        int32_t first = 0;  ///< of its items; of its two children where count is 0
        int32_t count = 0;
        int32_t axis = 0;
    };
    struct Leaf {
        TrueBox box;
        int32_t item = 0;
    };
    void split(size_t node, int32_t begin, int32_t end);

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
};

}  // namespace obscura::crosscheck
