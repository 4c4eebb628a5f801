// crosscheck/box_tree.h - a tree of boxes in double that collects what a ray may hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// A ray in double. The direction need not have length 1.
struct TrueRay {
    Vec3d origin, direction;
};

struct TrueBox {
    Vec3d low = {INFINITY, INFINITY, INFINITY};
    Vec3d high = {-INFINITY, -INFINITY, -INFINITY};

    void add(const Vec3d& p);
    void add(const TrueBox& other);
    /// Room for what rounds in double, a billion times more than is needed near the box.
    TrueBox with_room() const;
    TrueBox grown(double room) const { return {low - splat3(room), high + splat3(room)}; }
};

/// A ray as boxes want it.
class BoxRay {
public:
    explicit BoxRay(const TrueRay& ray);
    /// True when some of [0, limit] may lie in the box; true too where rounding leaves a doubt.
    bool meets(const TrueBox& box, double limit) const;

private:
    Vec3d origin_, inverse_;
};

/// Nothing here knows of Embree, and no box is smaller than what it holds: whoever is not visited
/// is not hit. Split at the middle item, so that the tree is as deep as the logarithm of its size.
class BoxTree {
public:
    explicit BoxTree(const std::vector<TrueBox>& boxes);

    /// Calls visit(i) for every box that the ray may meet before `limit`, which visit may lower;
    /// with room, for every one that it may pass as closely as that.
    template <typename Visit>
    void visit(const TrueRay& ray, const double& limit, const Visit& visit, double room = 0) const {
        if (nodes_.empty()) return;
        const BoxRay boxed(ray);
        int32_t stack[64];
        int size = 0;
        stack[size++] = 0;
        while (size > 0) {
            const Node& node = nodes_[static_cast<size_t>(stack[--size])];
            if (!boxed.meets(node.box.grown(room), limit)) continue;
            if (node.count > 0) {
                for (int32_t i = node.first; i < node.first + node.count; ++i)
                    visit(order_[static_cast<size_t>(i)]);
                continue;
            }
            const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
            const bool backwards = d[node.axis] < 0;
            stack[size++] = backwards ? node.first : node.first + 1;  // the far one waits
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
    void split(size_t node, const std::vector<TrueBox>& boxes, int32_t begin, int32_t end);

    std::vector<Node> nodes_;
    std::vector<int32_t> order_;
};

}  // namespace obscura
