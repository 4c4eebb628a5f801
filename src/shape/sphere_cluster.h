// shape/sphere_cluster.h - sixteen blocks of spheres, and one ray against the boxes around them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/shape_record.h"
#include "shape/sphere_block.h"

#include <cstdint>

namespace obscura {

/// Blocks in a cluster. The boxes of a cluster are columns: 16 minimum x, y and z, then 16 maximum
/// ones; unused entries are boxes that no ray hits.
inline constexpr int cluster_blocks = 16;
inline constexpr int cluster_floats = 6 * cluster_blocks;
inline constexpr int cluster_spheres = cluster_blocks * sphere_block;

/// Fills the boxes of one cluster.
///
/// In      spheres: of its first block; blocks: how many there are, at most cluster_blocks
/// Out     boxes: cluster_floats numbers
void fill_cluster_boxes(const float* spheres, int blocks, float* boxes);

/// The box around those boxes.
ShapeBox cluster_bounds(const float* boxes);

inline namespace OBSCURA_ISA {

/// The boxes that a ray enters.
struct BoxEntries {
    alignas(64) float t[cluster_blocks];  ///< where; unset for the others
    uint32_t bits = 0;                    ///< one for each box
};

/// One axis of the slab test: the ray's origin, the reciprocal of its direction, and the sides by
/// which it enters and leaves the boxes.
struct BoxAxis {
    float origin, inverse;
    const float* in;
    const float* out;
};

OBSCURA_INLINE BoxAxis box_axis(const float* boxes, int axis, float origin, float direction) {
    const float* low = boxes + axis * cluster_blocks;
    const float* high = low + 3 * cluster_blocks;
    // For rays parallel to the sides, 0 / 0 would be neither in nor out.
    constexpr float least = 1e-18f;
    const bool up = direction >= 0.0f;
    const float steep = up ? max(direction, least) : min(direction, -least);
    return {origin, 1.0f / steep, up ? low : high, up ? high : low};
}

/// The boxes that a ray enters within its limits. A box in whose side the ray runs may be missed:
/// its spheres do not reach its sides. Each side's t is rounded three times, in a difference, a
/// reciprocal and a product, so entry and exit are compared with a margin of six roundings.
OBSCURA_INLINE BoxEntries enter_boxes(const float* boxes,
                                      const ShapeRay<float>& ray,
                                      const Span<float>& limits) {
    const BoxAxis axes[3] = {box_axis(boxes, 0, ray.origin.x, ray.direction.x),
                             box_axis(boxes, 1, ray.origin.y, ray.direction.y),
                             box_axis(boxes, 2, ray.origin.z, ray.direction.z)};
    BoxEntries entries;
    for (int i = 0; i < cluster_blocks; i += lane_count) {
        Lanes in(limits.low);
        Lanes out(limits.high);
        for (const BoxAxis& axis : axes) {
            const Lanes origin(axis.origin);
            const Lanes inverse(axis.inverse);
            in = max(in, (load(axis.in + i) - origin) * inverse);
            out = min(out, (load(axis.out + i) - origin) * inverse);
        }
        store(entries.t + i, in);
        entries.bits |= mask_bits(in <= out * Lanes(1.000001f)) << i;
    }
    return entries;
}

/// Of the boxes in `bits`, the one that the ray enters first.
OBSCURA_INLINE int first_entry(const BoxEntries& entries, uint32_t bits) {
    int first = __builtin_ctz(bits);
    for (bits &= bits - 1; bits != 0; bits &= bits - 1) {
        const int other = __builtin_ctz(bits);
        if (entries.t[other] < entries.t[first]) first = other;
    }
    return first;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
