// stages/rows.h - moves rows between columns and lanes, and packs the lanes that go on.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "stages/doors.h"

namespace obscura {
inline namespace OBSCURA_ISA {

OBSCURA_INLINE Vec3<Lanes> load3(const float* x, const float* y, const float* z, int i) {
    return {load(x + i), load(y + i), load(z + i)};
}

OBSCURA_INLINE void store3(float* x, float* y, float* z, int i, const Vec3<Lanes>& v) {
    store(x + i, v.x);
    store(y + i, v.y);
    store(z + i, v.z);
}

/// The lanes of the group that starts at row `first` and exist in a column of `count` rows.
OBSCURA_INLINE Mask rows_in_range(int first, int count) {
    return lane_numbers() < LanesI(count - first);
}

/// One group of travelling paths in registers.
struct PathLanes {
    Vec3<Lanes> origin, direction, throughput;
    Lanes pdf, cone_width, cone_spread;
    LanesU slot, key, sample, path_key, bodies;
};

OBSCURA_INLINE PathLanes load_paths(const PathRows& rows, int i) {
    return {load3(rows.ox, rows.oy, rows.oz, i),
            load3(rows.dx, rows.dy, rows.dz, i),
            load3(rows.tr, rows.tg, rows.tb, i),
            load(rows.pdf + i),
            load(rows.cone_width + i),
            load(rows.cone_spread + i),
            load(rows.slot + i),
            load(rows.key + i),
            load(rows.sample + i),
            load(rows.path_key + i),
            load(rows.bodies + i)};
}

OBSCURA_INLINE Vec3<Lanes> pack(const Packer& packer, const Vec3<Lanes>& v) {
    return {packer(v.x), packer(v.y), packer(v.z)};
}

OBSCURA_INLINE LanesI pack(const Packer& packer, LanesI v) {
    return float_bits(packer(bits_float(v)));
}

OBSCURA_INLINE LanesU pack(const Packer& packer, LanesU v) {
    return as_uint(pack(packer, as_int(v)));
}

/// Appends the lanes of `mask` at row `count`; returns the new count.
OBSCURA_INLINE int append_paths(const PathRows& rows, int at, Mask mask, const PathLanes& p) {
    const Packer packer(mask);
    store3(rows.ox, rows.oy, rows.oz, at, pack(packer, p.origin));
    store3(rows.dx, rows.dy, rows.dz, at, pack(packer, p.direction));
    store3(rows.tr, rows.tg, rows.tb, at, pack(packer, p.throughput));
    store(rows.pdf + at, packer(p.pdf));
    store(rows.cone_width + at, packer(p.cone_width));
    store(rows.cone_spread + at, packer(p.cone_spread));
    store(rows.slot + at, pack(packer, p.slot));
    store(rows.key + at, pack(packer, p.key));
    store(rows.sample + at, pack(packer, p.sample));
    store(rows.path_key + at, pack(packer, p.path_key));
    store(rows.bodies + at, pack(packer, p.bodies));
    return at + count(mask);
}

struct HitLanes {
    Lanes t, u, v;
    LanesI instance, primitive, triangle;
    Lanes time = Lanes(0.0f);             ///< 0 when the shutter opens, 1 when it closes
    const SharedFaces* shared = nullptr;  ///< by slot; null: no path meets any
};

OBSCURA_INLINE HitLanes load_hits(const HitRows& rows, int i) {
    return {load(rows.t + i),
            load(rows.u + i),
            load(rows.v + i),
            load(rows.instance + i),
            load(rows.primitive + i),
            load(rows.triangle + i)};
}

/// Hits of one group. Lanes outside the mask, which must have one, repeat its first, so that
/// gathers stay in range.
OBSCURA_INLINE HitLanes hits_or_first(const HitRows& rows, int i, Mask valid) {
    const HitLanes hit = load_hits(rows, i);
    const int first = i + __builtin_ctz(mask_bits(valid));
    return {select(valid, hit.t, Lanes(rows.t[first])),
            select(valid, hit.u, Lanes(rows.u[first])),
            select(valid, hit.v, Lanes(rows.v[first])),
            select(valid, hit.instance, LanesI(rows.instance[first])),
            select(valid, hit.primitive, LanesI(rows.primitive[first])),
            select(valid, hit.triangle, LanesI(rows.triangle[first]))};
}

OBSCURA_INLINE void append_hits(const HitRows& rows, int at, Mask mask, const HitLanes& h) {
    const Packer packer(mask);
    store(rows.t + at, packer(h.t));
    store(rows.u + at, packer(h.u));
    store(rows.v + at, packer(h.v));
    store(rows.instance + at, pack(packer, h.instance));
    store(rows.primitive + at, pack(packer, h.primitive));
    store(rows.triangle + at, pack(packer, h.triangle));
}

struct ShadowLanes {
    Vec3<Lanes> origin, direction;
    Lanes tfar;
    Vec3<Lanes> radiance;
    LanesU slot, path_key;
};

OBSCURA_INLINE ShadowLanes load_shadows(const ShadowRows& rows, int i) {
    return {load3(rows.ox, rows.oy, rows.oz, i),
            load3(rows.dx, rows.dy, rows.dz, i),
            load(rows.tfar + i),
            load3(rows.r, rows.g, rows.b, i),
            load(rows.slot + i),
            load(rows.path_key + i)};
}

OBSCURA_INLINE int append_shadows(const ShadowRows& rows, int at, Mask mask, const ShadowLanes& s) {
    const Packer packer(mask);
    store3(rows.ox, rows.oy, rows.oz, at, pack(packer, s.origin));
    store3(rows.dx, rows.dy, rows.dz, at, pack(packer, s.direction));
    store(rows.tfar + at, packer(s.tfar));
    store3(rows.r, rows.g, rows.b, at, pack(packer, s.radiance));
    store(rows.slot + at, pack(packer, s.slot));
    store(rows.path_key + at, pack(packer, s.path_key));
    return at + count(mask);
}

/// What to add to one column of slots.
struct SlotColumn {
    float* column;
    Lanes add;
};

/// Adds to the slots of the lanes in `mask`. No slot appears twice in one group.
template <int columns>
OBSCURA_INLINE void add_to_slots(Mask mask, LanesU slot, const SlotColumn (&to)[columns]) {
    const auto first = static_cast<uint32_t>(first_lane(as_int(slot)));
    const LanesU neighbours = LanesU(first) + as_uint(lane_numbers());
    if (all(mask & (slot == neighbours))) {  // as the camera leaves them
        for (const SlotColumn& c : to)
            store(c.column + first, load(c.column + first) + c.add);
        return;
    }
    alignas(64) uint32_t slots[lane_count];
    alignas(64) float add[columns][lane_count];
    store(slots, slot);
    for (int k = 0; k < columns; ++k)
        store(add[k], to[k].add);
    for (uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        for (int k = 0; k < columns; ++k)
            to[k].column[slots[lane]] += add[k][lane];
    }
}

/// Writes one number by slot, for the lanes of `mask`.
OBSCURA_INLINE void store_by_slot(float* column, Mask mask, LanesU slot, Lanes value) {
    alignas(64) uint32_t slots[lane_count];
    alignas(64) float values[lane_count];
    store(slots, slot);
    store(values, value);
    for (uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        column[slots[lane]] = values[lane];
    }
}

OBSCURA_INLINE void add_radiance(const SampleRows& samples,
                                 Mask mask,
                                 LanesU slot,
                                 const Vec3<Lanes>& rgb) {
    add_to_slots(mask, slot, {{samples.r, rgb.x}, {samples.g, rgb.y}, {samples.b, rgb.z}});
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
