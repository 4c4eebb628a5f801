// shape/sphere_block.h - many spheres: sixteen side by side, and one ray against all of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/sphere.h"

#include <cstdint>

namespace obscura {

/// Spheres in a block. Blocks are columns: 16 x, 16 y, 16 z, 16 radii; rows that are not there have
/// a radius that is no number, which nothing hits.
inline constexpr int sphere_block = 16;
inline constexpr int sphere_block_floats = 4 * sphere_block;

/// Float at which sphere `row` of a table of blocks has its x; y, z and radius follow at steps of
/// sphere_block.
template <typename I>
OBSCURA_INLINE I sphere_word(const I& row) {
    const I within = row & I(sphere_block - 1);
    return (row - within) * I(4) + within;
}

inline namespace OBSCURA_ISA {

/// The nearest of a block's spheres.
struct BlockHit {
    float t = 0;
    int sphere = -1;  ///< in the block; -1: none
};

/// The nearest hit of one ray in (tnear, tfar] with one block, the spheres in the lanes.
///
/// In      block: sphere_block_floats numbers; front_only: where the ray comes out does not count
OBSCURA_INLINE BlockHit intersect_sphere_block(const float* block,
                                               const ShapeRay<float>& ray,
                                               const Span<float>& limits,
                                               bool front_only) {
    const ShapeRay<Lanes> wide{
        {Lanes(ray.origin.x), Lanes(ray.origin.y), Lanes(ray.origin.z)},
        {Lanes(ray.direction.x), Lanes(ray.direction.y), Lanes(ray.direction.z)}};
    BlockHit best{limits.high, -1};
    for (int i = 0; i < sphere_block; i += lane_count) {
        const Sphere<Lanes> spheres{
            {load(block + i), load(block + sphere_block + i), load(block + 2 * sphere_block + i)},
            load(block + 3 * sphere_block + i)};
        Roots<Lanes> roots = intersect_sphere(spheres, wide);
        if (front_only) roots.hit[1] = Mask(false);
        const NearHit<Lanes> hit = nearest(roots, Lanes(limits.low), Lanes(best.t));
        uint32_t bits = mask_bits(hit.found);
        if (bits == 0) continue;
        alignas(64) float t[lane_count];
        store(t, hit.t);
        for (; bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            if (best.sphere < 0 || t[lane] < best.t) best = {t[lane], i + lane};
        }
    }
    return best;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
