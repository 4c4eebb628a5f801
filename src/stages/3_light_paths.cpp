// stages/3_light_paths.cpp - moves the weights of paths by the shares of lobes; sorts light in.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_light_paths.h"

#include "stages/light_paths.h"
#include "surface/lobe_shares.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Colours of a group, lane by lane.
struct ColorLanes {
    alignas(64) float r[lane_count], g[lane_count], b[lane_count];

    Vec3<float> at(int lane) const { return {r[lane], g[lane], b[lane]}; }
};

OBSCURA_INLINE void store_color(const Vec3<Lanes>& color, ColorLanes& out) {
    store(out.r, color.x);
    store(out.g, color.y);
    store(out.b, color.z);
}

/// The lobes that scatter light in some lane of a group.
struct StoredShares {
    int count = 0;
    int lobe[Lobes::count];
    Mask singular[Lobes::count];
    Mask exists[Lobes::count];
    ColorLanes share[Lobes::count];
};

OBSCURA_INLINE void choose(LobeShares<Lanes>& out, Mask m, const LobeShares<Lanes>& in) {
    for (int k = 0; k < Lobes::count; ++k) {
        out.share[k] = select(m, in.share[k], out.share[k]);
        out.singular[k] = (m & in.singular[k]) | ((!m) & out.singular[k]);
        out.exists[k] = (m & in.exists[k]) | ((!m) & out.exists[k]);
    }
}

void find_shares(Mask lanes, const Scattering& at, StoredShares& out) {
    const ShadingPoint& s = at.s;
    LobeShares<Lanes> shares;
    // Called once: a second inlined copy might round differently, and bits depend on neighbours.
    share_bsdf(s.bsdf, s.lobes, at.wo, at.wi, shares);
    if (s.any_layers) {
        LobeShares<Lanes> layered;
        share_layered(s.layers.params, s.layers.weights, at.wo, at.wi, layered);
        choose(shares, s.layers.layered, layered);
    }
    for (int k = 0; k < Lobes::count; ++k) {
        const Mask exists = shares.exists[k] & lanes;
        if (none(exists)) continue;
        out.lobe[out.count] = k;
        out.exists[out.count] = exists;
        out.singular[out.count] = shares.singular[k];
        store_color(shares.share[k], out.share[out.count++]);
    }
}

/// A part of a path's light, in one state.
struct StateWeight {
    uint16_t state;
    Vec3<float> weight;
};

/// The states that a path is in. Returns how many.
int states_of(const ColorColumns& weights, uint32_t slot, StateWeight* out) {
    int count = 0;
    for (int k = 0; k < *weights.used_count; ++k) {
        const uint16_t state = weights.used[k];
        const float* red = weights.memory + size_t{3} * padded_slots * state;
        const Vec3<float> weight = color_at(red, slot);
        if (weight.x != 0 || weight.y != 0 || weight.z != 0) out[count++] = {state, weight};
    }
    return count;
}

uint16_t next_state(const LightPathTable& table, uint16_t state, int lobe, bool singular) {
    const size_t event = static_cast<size_t>(lobe) + (singular ? singular_events : 0);
    return table.next[state * scatter_event_count + event];
}

/// The scattering of one path.
struct LaneShares {
    const StoredShares& shares;
    int lane;
    uint32_t slot;
};

/// Moves one state's part of a path by the lobes of a scattering. False when it may move on later.
bool move_weight(const LightPathTable& table,
                 const StateWeight& from,
                 const LaneShares& scattering,
                 const ColorColumns& to) {
    const StoredShares& shares = scattering.shares;
    const int lane = scattering.lane;
    bool settled = true;
    for (int k = 0; k < shares.count; ++k) {
        if ((mask_bits(shares.exists[k]) >> lane & 1U) == 0) continue;
        const bool singular = (mask_bits(shares.singular[k]) >> lane & 1U) != 0;
        const uint16_t next = next_state(table, from.state, shares.lobe[k], singular);
        add_color(to, next, scattering.slot, from.weight * shares.share[k].at(lane));
        settled = settled && table.settled[next] != 0;
    }
    return settled;
}

/// Adds to one colour of the lanes' samples.
OBSCURA_INLINE void add_color_lanes(
    const ColorColumns& columns, uint16_t number, Mask lanes, LanesU slot, const Vec3<Lanes>& add) {
    float* const red = use_color(columns, number);
    float* const green = red + padded_slots;
    add_to_slots(lanes, slot, {{red, add.x}, {green, add.y}, {green + padded_slots, add.z}});
}

/// The same from the first state, for all lanes at once. Returns the lanes that are settled then.
Mask leave_start(const LightPathTable& table,
                 const StoredShares& shares,
                 Mask lanes,
                 const ColorColumns& to,
                 LanesU slot) {
    Mask settled = lanes;
    for (int k = 0; k < shares.count; ++k) {
        const ColorLanes& share = shares.share[k];
        for (const bool singular : {false, true}) {
            const Mask those = singular ? shares.singular[k] : !shares.singular[k];
            const Mask moved = shares.exists[k] & lanes & those;
            if (none(moved)) continue;
            const uint16_t next = next_state(table, 0, shares.lobe[k], singular);
            if (table.settled[next] == 0) settled = settled & (!moved);
            add_color_lanes(to, next, moved, slot, {load(share.r), load(share.g), load(share.b)});
        }
    }
    return settled;
}

/// Colours of the lanes' samples; 0 in the other lanes.
OBSCURA_INLINE Vec3<Lanes> color_lanes(const ColorColumns& columns,
                                       uint16_t number,
                                       Mask lanes,
                                       LanesU slot) {
    const float* const red = columns.memory + size_t{3} * padded_slots * number;
    const LanesI at = select(lanes, as_int(slot), LanesI(0));
    const Vec3<Lanes> color{gather<Lanes>(red, at),
                            gather<Lanes>(red + padded_slots, at),
                            gather<Lanes>(red + size_t{2} * padded_slots, at)};
    return select(lanes, color, splat3(Lanes(0.0f)));
}

/// settle_by_any_lobe for all lanes at once. False: a state of theirs leads to others, and none has
/// moved.
bool settle_lanes_by_any_lobe(const LightPathColumns& columns, Mask lanes, LanesU slot) {
    const LightPathTable& table = *columns.table;
    const ColorColumns& weights = columns.weights;
    uint16_t moving[max_path_states];
    int count = 0;
    for (int k = 0; k < *weights.used_count; ++k) {
        const uint16_t state = weights.used[k];
        const uint16_t next = table.common_next[state];
        if (next == no_common_state) {
            const Vec3<Lanes> weight = color_lanes(weights, state, lanes, slot);
            if (any(max_component(weight) != Lanes(0.0f))) return false;
        } else if (next != state) {
            moving[count++] = state;
        }
    }
    // What is left behind in states that are not settled counts no more: see finish.
    for (int k = 0; k < count; ++k) {
        const Vec3<Lanes> weight = color_lanes(weights, moving[k], lanes, slot);
        const Mask has = max_component(weight) != Lanes(0.0f);
        if (any(has)) add_color_lanes(weights, table.common_next[moving[k]], has, slot, weight);
    }
    return true;
}

/// Settles a path whose states lead to settled ones whatever the lobe. False: there are others, and
/// it has not moved.
bool settle_by_any_lobe(const LightPathColumns& columns,
                        const StateWeight* from,
                        int count,
                        uint32_t slot) {
    const LightPathTable& table = *columns.table;
    for (int k = 0; k < count; ++k) {
        if (table.common_next[from[k].state] == no_common_state) return false;
    }
    for (int k = 0; k < count; ++k) {
        const uint16_t next = table.common_next[from[k].state];
        if (next == from[k].state) continue;
        clear_color(columns.weights, from[k].state, slot);
        add_color(columns.weights, next, slot, from[k].weight);
    }
    columns.settled[slot] = 1;
    return true;
}

/// Lanes whose paths are not settled.
OBSCURA_INLINE Mask moving_lanes(const LightPathColumns& columns, Mask lanes, LanesU slot) {
    const LanesI at = select(lanes, as_int(slot), LanesI(0));
    return lanes & (gather<Lanes>(columns.settled, at) == LanesU(0U));
}

void set_words(uint32_t* column, Mask lanes, const uint32_t* slots) {
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1)
        column[slots[__builtin_ctz(bits)]] = 1;
}

/// Adds light of one class to paths.
void add_light_lanes(const LightPathColumns& columns,
                     Mask lanes,
                     LanesU slot,
                     uint32_t light_class,
                     const Vec3<Lanes>& radiance) {
    const LightPathTable& table = *columns.table;
    if (columns.all_at_start && table.settled[0] == 0) {
        for (uint32_t i = table.layer_begin[light_class]; i < table.layer_begin[light_class + 1];
             ++i)
            add_color_lanes(columns.layers, table.layers[i], lanes, slot, radiance);
        return;
    }
    const Mask moving = moving_lanes(columns, lanes, slot);
    const Mask settled = lanes & (!moving);
    const uint16_t sum = table.sum_of_class[light_class];
    if (any(settled) && sum != no_light_sum)
        add_color_lanes(columns.sums, sum, settled, slot, radiance);
    if (none(moving)) return;
    alignas(64) uint32_t slots[lane_count];
    ColorLanes color;
    store(slots, slot);
    store_color(radiance, color);
    for (uint32_t bits = mask_bits(moving); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        add_light(columns, columns.weights, {slots[lane], light_class, color.at(lane)});
    }
}

}  // namespace

void add_emitted_light(const LightPathColumns& columns,
                       Mask lanes,
                       const HitLanes& hit,
                       LanesU slot,
                       const Vec3<Lanes>& radiance) {
    alignas(64) uint32_t slots[lane_count];
    alignas(64) int32_t primitive[lane_count];
    alignas(64) int32_t instance[lane_count];
    ColorLanes color;
    store(slots, slot);
    store(primitive, hit.primitive);
    store(instance, hit.instance);
    store_color(radiance, color);
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t light_class = emitter_class(*columns.table, primitive[lane], instance[lane]);
        const ArrivingLight light{slots[lane], light_class, color.at(lane)};
        if (columns.settled[light.slot] != 0) {
            add_settled_light(columns, light);
        } else {
            add_light(columns, columns.weights, light);
        }
    }
}

void add_background_light(const LightPathColumns& columns,
                          Mask lanes,
                          LanesU slot,
                          const Vec3<Lanes>& radiance) {
    add_light_lanes(columns, lanes, slot, background_class(*columns.table), radiance);
}

void note_shadow_class(const LightPathColumns& columns, Mask lanes, LanesU slot, LanesI light) {
    alignas(64) uint32_t slots[lane_count];
    alignas(64) int32_t lights[lane_count];
    store(slots, slot);
    store(lights, light);
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        columns.shadow_class[slots[lane]] = columns.table->class_of_light[lights[lane]];
    }
}

void scatter_shadow(const LightPathColumns& columns,
                    Mask lanes,
                    LanesU slot,
                    LanesI light,
                    const Scattering& scattering) {
    const LightPathTable& table = *columns.table;
    alignas(64) uint32_t slots[lane_count];
    store(slots, slot);
    note_shadow_class(columns, lanes, slot, light);
    const Mask moving = moving_lanes(columns, lanes, slot);
    if (none(moving)) return;
    StoredShares shares;
    if (columns.all_at_start) {
        find_shares(lanes, scattering, shares);
        leave_start(table, shares, moving, columns.shadow_weights, slot);
        set_words(columns.shadow_split, moving, slots);
        return;
    }
    // Whatever lobe a path takes next, its shadow ray has the same weights.
    if (!columns.goes_straight && settle_lanes_by_any_lobe(columns, moving, slot)) {
        set_words(columns.settled, moving, slots);
        return;
    }
    StateWeight from[max_path_states];
    bool found = false;
    for (uint32_t bits = mask_bits(moving); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t at = slots[lane];
        const int count = states_of(columns.weights, at, from);
        if (!columns.goes_straight && settle_by_any_lobe(columns, from, count, at)) continue;
        if (!found) find_shares(lanes, scattering, shares);
        found = true;
        columns.shadow_split[at] = 1;
        for (int k = 0; k < count; ++k) {
            if (table.settled[from[k].state] != 0) {
                add_color(columns.shadow_weights, from[k].state, at, from[k].weight);
            } else {
                move_weight(table, from[k], {shares, lane, at}, columns.shadow_weights);
            }
        }
    }
}

void scatter_path(const LightPathColumns& columns,
                  Mask lanes,
                  LanesU slot,
                  const Scattering& scattering) {
    const LightPathTable& table = *columns.table;
    alignas(64) uint32_t slots[lane_count];
    store(slots, slot);
    const Mask moving = moving_lanes(columns, lanes, slot);
    if (none(moving)) return;
    StoredShares shares;
    if (columns.all_at_start) {
        find_shares(lanes, scattering, shares);
        for (uint32_t bits = mask_bits(moving); bits != 0; bits &= bits - 1)
            clear_color(columns.weights, 0, slots[__builtin_ctz(bits)]);
        set_words(
            columns.settled, leave_start(table, shares, moving, columns.weights, slot), slots);
        return;
    }
    if (settle_lanes_by_any_lobe(columns, moving, slot)) {
        set_words(columns.settled, moving, slots);
        return;
    }
    StateWeight from[max_path_states];
    bool found = false;
    for (uint32_t bits = mask_bits(moving); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t at = slots[lane];
        const int count = states_of(columns.weights, at, from);
        if (settle_by_any_lobe(columns, from, count, at)) continue;
        if (!found) find_shares(lanes, scattering, shares);
        found = true;
        bool settled = true;
        for (int k = 0; k < count; ++k) {
            if (table.settled[from[k].state] == 0) clear_color(columns.weights, from[k].state, at);
        }
        for (int k = 0; k < count; ++k) {
            if (table.settled[from[k].state] != 0) continue;
            settled &= move_weight(table, from[k], {shares, lane, at}, columns.weights);
        }
        columns.settled[at] = settled ? 1 : 0;
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
