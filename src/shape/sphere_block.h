// shape/sphere_block.h - sixteen spheres side by side, and one ray against all of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/sphere.h"

#include <cstdint>

namespace obscura {

/// Spheres in a block. Blocks are columns: 16 x, 16 y, 16 z, 16 radii; unused entries have a NaN
/// radius, which nothing hits.
inline constexpr int sphere_block = 16;
inline constexpr int sphere_block_floats = 4 * sphere_block;

/// Float at which sphere `index` of a table of blocks has its x; y, z and radius follow at steps of
/// sphere_block.
template <typename I>
OBSCURA_INLINE I sphere_word(const I& index) {
    const I within = index & I(sphere_block - 1);
    return (index - within) * I(4) + within;
}

inline namespace OBSCURA_ISA {

/// The nearest of a block's spheres.
struct BlockHit {
    float t = 0;
    int sphere = -1;  ///< in the block; -1: none
};

/// The spheres that the ray's line may hit, by an approximate distance with a margin for rounding.
/// It rejects most blocks whose box a ray passes.
///
/// In   squared_length: of the direction
OBSCURA_INLINE Mask may_meet(const float* block,
                             const ShapeRay<float>& ray,
                             const Vec3<Lanes>& d,
                             float squared_length) {
    const auto offset = [&](float origin, int column) {
        return Lanes(origin) - load(block + column * sphere_block);
    };
    const Vec3<Lanes> p{offset(ray.origin.x, 0), offset(ray.origin.y, 1), offset(ray.origin.z, 2)};
    const Vec3<Lanes> across = cross(p, d);
    const Lanes rounding = (abs(p.x) + abs(p.y) + abs(p.z)) * Lanes(1e-6f);
    const Lanes reach = load(block + 3 * sphere_block) + rounding;
    return dot(across, across) <= reach * reach * Lanes(squared_length);
}

/// Both roots of one ray with the spheres in the lanes; as intersect_sphere, but the ray's own
/// numbers are computed once, and it returns early if all lanes miss.
OBSCURA_INLINE Roots<Lanes> roots_in_lanes(const float* block,
                                           const ShapeRay<float>& ray,
                                           float squared_length) {
    const Vec3<Lanes> d{Lanes(ray.direction.x), Lanes(ray.direction.y), Lanes(ray.direction.z)};
    if (none(may_meet(block, ray, d, squared_length))) return {{}, {Mask(false), Mask(false)}};
    const auto offset = [&](float origin, int column) {
        return two_sum(Lanes(origin), Lanes(-load(block + column * sphere_block)));
    };
    const Exact<Lanes> x = offset(ray.origin.x, 0);
    const Exact<Lanes> y = offset(ray.origin.y, 1);
    const Exact<Lanes> z = offset(ray.origin.z, 2);
    const Lanes inverse(1.0f / squared_length);
    const Lanes t = -dot(Vec3<Lanes>{x.value, y.value, z.value}, d) * inverse;
    const Vec3<Lanes> near{multiply_add(t, d.x, x.value) + x.error,
                           multiply_add(t, d.y, y.value) + y.error,
                           multiply_add(t, d.z, z.value) + z.error};
    const Lanes step = -dot(near, d) * inverse;
    const Vec3<Lanes> side{multiply_add(step, d.x, near.x),
                           multiply_add(step, d.y, near.y),
                           multiply_add(step, d.z, near.z)};
    const Lanes radius = load(block + 3 * sphere_block);
    const Lanes squared = dot(side, side);
    Roots<Lanes> roots;
    roots.hit[0] = squared <= radius * radius * Lanes(1.000001f);
    roots.hit[1] = roots.hit[0];
    if (none(roots.hit[0])) return roots;
    const Lanes distance = sqrt(squared);
    const Lanes squared_half = (radius - distance) * (radius + distance) * inverse;
    const Lanes half = sqrt(max(squared_half, Lanes(0.0f)));
    roots.t[0] = t + (step - half);
    roots.t[1] = t + (step + half);
    roots.hit[0] = squared_half >= Lanes(0.0f);
    roots.hit[1] = roots.hit[0];
    return roots;
}

/// The nearest hit of one ray in (limits.low, limits.high] with one block.
///
/// In      block: sphere_block_floats numbers; front_only: ignores exits
OBSCURA_INLINE BlockHit intersect_sphere_block(const float* block,
                                               const ShapeRay<float>& ray,
                                               const Span<float>& limits,
                                               bool front_only) {
    const float squared_length = dot(ray.direction, ray.direction);
    BlockHit best{limits.high, -1};
    for (int i = 0; i < sphere_block; i += lane_count) {
        Roots<Lanes> roots = roots_in_lanes(block + i, ray, squared_length);
        if (none(roots.hit[0])) continue;
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
