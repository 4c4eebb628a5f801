// shape/sphere_cluster.cpp - boxes around blocks of spheres.
// SPDX-License-Identifier: Apache-2.0
#include "shape/sphere_cluster.h"

#include <algorithm>
#include <cmath>

namespace obscura {

void fill_cluster_boxes(const float* spheres, int blocks, float* boxes) {
    for (int i = 0; i < cluster_blocks; ++i) {
        ShapeBox box{splat3(INFINITY), splat3(-INFINITY)};
        if (i < blocks) box = sphere_block_bounds(spheres + int64_t{i} * sphere_block_floats);
        const float sides[6] = {
            box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z};
        for (int side = 0; side < 6; ++side)
            boxes[side * cluster_blocks + i] = sides[side];
    }
}

ShapeBox cluster_bounds(const float* boxes) {
    float sides[6];
    for (int side = 0; side < 6; ++side) {
        const float* first = boxes + int64_t{side} * cluster_blocks;
        sides[side] = side < 3 ? *std::min_element(first, first + cluster_blocks)
                               : *std::max_element(first, first + cluster_blocks);
    }
    return {{sides[0], sides[1], sides[2]}, {sides[3], sides[4], sides[5]}};
}

}  // namespace obscura
