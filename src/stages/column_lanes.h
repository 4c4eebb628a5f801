// stages/column_lanes.h - loads path state from columns into lanes; stores and compacts it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "stages/path_state.h"

#include <type_traits>

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

/// The lanes of the group that starts at index `first` and exist in a column of `count` entries.
OBSCURA_INLINE Mask lanes_in_range(int first, int count) {
    return lane_numbers() < LanesI(count - first);
}

#define OBSCURA_LANES_VECTOR(name, x, y, z) Vec3<Lanes> name;
#define OBSCURA_LANES_NUMBER(name) Lanes name;
#define OBSCURA_LANES_WORD(name) LanesU name;
#define OBSCURA_LANES_INTEGER(name) LanesI name;
/// Defines one group of entries in registers, from the list of its columns.
#define OBSCURA_LANES_OF(Name, LIST) \
    struct Name {                    \
        LIST(OBSCURA_LANES_VECTOR,   \
             OBSCURA_LANES_NUMBER,   \
             OBSCURA_LANES_WORD,     \
             OBSCURA_LANES_INTEGER)  \
    }

OBSCURA_LANES_OF(PathLanes, OBSCURA_PATH_COLUMNS);
OBSCURA_LANES_OF(MissLanes, OBSCURA_MISS_COLUMNS);
OBSCURA_LANES_OF(ShadowLanes, OBSCURA_SHADOW_COLUMNS);
OBSCURA_LANES_OF(HitColumnLanes, OBSCURA_HIT_COLUMNS);

struct HitLanes : HitColumnLanes {
    Lanes time = Lanes(0.0f);             ///< 0 when the shutter opens, 1 when it closes
    const SharedFaces* shared = nullptr;  ///< by sample index; null: no path meets any
};

/// Reads each field of a group from its columns.
struct GroupLoader {
    int first;

    OBSCURA_INLINE void operator()(Vec3<Lanes>& v,
                                   const float* x,
                                   const float* y,
                                   const float* z) const {
        v = load3(x, y, z, first);
    }
    template <typename L, typename Word>
    OBSCURA_INLINE void operator()(L& lanes, const Word* column) const {
        lanes = load(column + first);
    }
};

OBSCURA_INLINE PathLanes load_paths(const PathView& columns, int i) {
    PathLanes p;
    PathView::for_each_field(GroupLoader{i}, p, columns);
    return p;
}

OBSCURA_INLINE ShadowLanes load_shadows(const ShadowView& columns, int i) {
    ShadowLanes s;
    ShadowView::for_each_field(GroupLoader{i}, s, columns);
    return s;
}

OBSCURA_INLINE HitLanes load_hits(const HitView& columns, int i) {
    HitLanes h;
    HitView::for_each_field(GroupLoader{i}, h, columns);
    return h;
}

/// Hits of one group. Lanes outside the mask repeat its first lane, so that gathers stay in range;
/// the mask must not be empty.
OBSCURA_INLINE HitLanes hits_or_first(const HitView& columns, int i, Mask valid) {
    const int first = i + __builtin_ctz(mask_bits(valid));
    HitLanes h;
    const auto read = [&](auto& lanes, const auto* column) __attribute__((always_inline)) {
        using L = std::remove_reference_t<decltype(lanes)>;
        lanes = select(valid, load(column + i), L(column[first]));
    };
    HitView::for_each_field(read, h, columns);
    return h;
}

OBSCURA_INLINE Lanes pack(const Packer& packer, Lanes v) {
    return packer(v);
}

OBSCURA_INLINE LanesI pack(const Packer& packer, LanesI v) {
    return float_bits(packer(bits_float(v)));
}

OBSCURA_INLINE LanesU pack(const Packer& packer, LanesU v) {
    return as_uint(pack(packer, as_int(v)));
}

/// Writes the lanes that a packer keeps, side by side, from an index on.
struct GroupPacker {
    const Packer& packer;
    int at;

    OBSCURA_INLINE void operator()(const Vec3<Lanes>& v, float* x, float* y, float* z) const {
        store3(x, y, z, at, {packer(v.x), packer(v.y), packer(v.z)});
    }
    template <typename L, typename Word>
    OBSCURA_INLINE void operator()(const L& lanes, Word* column) const {
        store(column + at, pack(packer, lanes));
    }
};

/// Appends the lanes of `mask` at index `at`; returns the new count.
OBSCURA_INLINE int append_paths(const PathColumns& columns, int at, Mask mask, const PathLanes& p) {
    const Packer packer(mask);
    PathColumns::for_each_field(GroupPacker{packer, at}, p, columns);
    return at + count(mask);
}

OBSCURA_INLINE void append_hits(const HitColumns& columns, int at, Mask mask, const HitLanes& h) {
    const Packer packer(mask);
    HitColumns::for_each_field(GroupPacker{packer, at}, h, columns);
}

/// Appends the paths of `mask` that left the scene, in the group that starts at index i of `paths`.
OBSCURA_INLINE int append_misses(
    const MissColumns& columns, int at, Mask mask, const PathView& paths, int i) {
    MissLanes m;
    MissColumns::for_each_field(GroupLoader{i}, m, paths);
    const Packer packer(mask);
    MissColumns::for_each_field(GroupPacker{packer, at}, m, columns);
    return at + count(mask);
}

OBSCURA_INLINE int append_shadows(const ShadowColumns& columns,
                                  int at,
                                  Mask mask,
                                  const ShadowLanes& s) {
    const Packer packer(mask);
    ShadowColumns::for_each_field(GroupPacker{packer, at}, s, columns);
    return at + count(mask);
}

/// Gathers the entries with these indices from a column; one column at a time fits the nearest
/// cache. Works in place if the indices ascend.
template <typename Word>
void take_entries(const uint16_t* index, int count, const Word* from, Word* to) {
    for (int i = 0; i < count; ++i)
        to[i] = from[index[i]];
}

/// Values to add to one column of samples.
struct SlotColumn {
    float* column;
    Lanes add;
};

/// Adds to the samples of the lanes in `mask`. No sample appears twice in one group.
template <int columns>
OBSCURA_INLINE void add_to_slots(Mask mask, LanesU slot, const SlotColumn (&to)[columns]) {
    const auto first = static_cast<uint32_t>(first_lane(as_int(slot)));
    const LanesU neighbours = LanesU(first) + as_uint(lane_numbers());
    // As the camera leaves them; lanes with nothing to add may lie between.
    if (first < batch_size && all((!mask) | (slot == neighbours))) {
        for (const SlotColumn& c : to) {
            const Lanes add = select(mask, c.add, Lanes(0.0f));
            store(c.column + first, load(c.column + first) + add);
        }
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

/// Writes one word by sample index, for the lanes of `mask`.
template <typename L, typename Word>
OBSCURA_INLINE void store_by_slot(Word* column, Mask mask, LanesU slot, L value) {
    alignas(64) uint32_t slots[lane_count];
    alignas(64) Word values[lane_count];
    store(slots, slot);
    store(values, value);
    for (uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        column[slots[lane]] = values[lane];
    }
}

OBSCURA_INLINE void add_radiance(const SampleColumns& samples,
                                 Mask mask,
                                 LanesU slot,
                                 const Vec3<Lanes>& rgb) {
    add_to_slots(mask, slot, {{samples.r, rgb.x}, {samples.g, rgb.y}, {samples.b, rgb.z}});
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
