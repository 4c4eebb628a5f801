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
    uint32_t singular[Lobes::count];  ///< bit by lane
    uint32_t exists[Lobes::count];    ///< likewise
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
        const uint32_t exists = mask_bits(shares.exists[k] & lanes);
        if (exists == 0) continue;
        out.lobe[out.count] = k;
        out.exists[out.count] = exists;
        out.singular[out.count] = mask_bits(shares.singular[k]);
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

/// Moves one state's part of a path by the lobes of a scattering. False when it may move on later.
bool move_weight(const LightPathTable& table,
                 const StateWeight& from,
                 const StoredShares& shares,
                 int lane,
                 const ColorColumns& to,
                 uint32_t slot) {
    bool settled = true;
    for (int k = 0; k < shares.count; ++k) {
        if ((shares.exists[k] >> lane & 1U) == 0) continue;
        const bool singular = (shares.singular[k] >> lane & 1U) != 0;
        const uint16_t next = next_state(table, from.state, shares.lobe[k], singular);
        add_color(to, next, slot, from.weight * shares.share[k].at(lane));
        settled = settled && table.settled[next] != 0;
    }
    return settled;
}

/// The same from the first state, for all lanes at once. Returns the lanes that are settled then.
uint32_t leave_start(const LightPathTable& table,
                     const StoredShares& shares,
                     uint32_t lanes,
                     const ColorColumns& to,
                     const uint32_t* slots) {
    uint32_t settled = lanes;
    for (int k = 0; k < shares.count; ++k) {
        for (const bool singular : {false, true}) {
            const uint32_t those = singular ? shares.singular[k] : ~shares.singular[k];
            const uint32_t moved = shares.exists[k] & lanes & those;
            if (moved == 0) continue;
            const uint16_t next = next_state(table, 0, shares.lobe[k], singular);
            if (table.settled[next] == 0) settled &= ~moved;
            float* const red = use_color(to, next);
            for (uint32_t bits = moved; bits != 0; bits &= bits - 1) {
                const int lane = __builtin_ctz(bits);
                float* const at = red + slots[lane];
                at[0] += shares.share[k].r[lane];
                at[padded_slots] += shares.share[k].g[lane];
                at[size_t{2} * padded_slots] += shares.share[k].b[lane];
            }
        }
    }
    return settled;
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
uint32_t moving_lanes(const LightPathColumns& columns, Mask lanes, const uint32_t* slots) {
    uint32_t moving = 0;
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        if (columns.settled[slots[lane]] == 0) moving |= 1U << lane;
    }
    return moving;
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
             ++i) {
            float* const red = use_color(columns.layers, table.layers[i]);
            add_to_slots(lanes,
                         slot,
                         {{red, radiance.x},
                          {red + padded_slots, radiance.y},
                          {red + size_t{2} * padded_slots, radiance.z}});
        }
        return;
    }
    alignas(64) uint32_t slots[lane_count];
    ColorLanes color;
    store(slots, slot);
    store_color(radiance, color);
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const bool settled = columns.settled[slots[lane]] != 0;
        add_light(columns, columns.weights, settled, slots[lane], light_class, color.at(lane));
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
        const bool settled = columns.settled[slots[lane]] != 0;
        add_light(columns, columns.weights, settled, slots[lane], light_class, color.at(lane));
    }
}

void add_background_light(const LightPathColumns& columns,
                          Mask lanes,
                          LanesU slot,
                          const Vec3<Lanes>& radiance) {
    add_light_lanes(columns, lanes, slot, background_class(*columns.table), radiance);
}

void scatter_shadow(const LightPathColumns& columns,
                    Mask lanes,
                    LanesU slot,
                    LanesI light,
                    const Scattering& scattering) {
    const LightPathTable& table = *columns.table;
    alignas(64) uint32_t slots[lane_count];
    alignas(64) int32_t lights[lane_count];
    store(slots, slot);
    store(lights, light);
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        columns.shadow_class[slots[lane]] = table.class_of_light[lights[lane]];
    }
    const uint32_t moving = moving_lanes(columns, lanes, slots);
    if (moving == 0) return;
    StoredShares shares;
    if (columns.all_at_start) {
        find_shares(lanes, scattering, shares);
        leave_start(table, shares, moving, columns.shadow_weights, slots);
        for (uint32_t bits = moving; bits != 0; bits &= bits - 1)
            columns.shadow_split[slots[__builtin_ctz(bits)]] = 1;
        return;
    }
    StateWeight from[max_path_states];
    bool found = false;
    for (uint32_t bits = moving; bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t at = slots[lane];
        const int count = states_of(columns.weights, at, from);
        // Whatever lobe the path takes next, its shadow ray has the same weights.
        if (!columns.goes_straight && settle_by_any_lobe(columns, from, count, at)) continue;
        if (!found) find_shares(lanes, scattering, shares);
        found = true;
        columns.shadow_split[at] = 1;
        for (int k = 0; k < count; ++k) {
            if (table.settled[from[k].state] != 0) {
                add_color(columns.shadow_weights, from[k].state, at, from[k].weight);
            } else {
                move_weight(table, from[k], shares, lane, columns.shadow_weights, at);
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
    const uint32_t moving = moving_lanes(columns, lanes, slots);
    if (moving == 0) return;
    StoredShares shares;
    if (columns.all_at_start) {
        find_shares(lanes, scattering, shares);
        for (uint32_t bits = moving; bits != 0; bits &= bits - 1)
            clear_color(columns.weights, 0, slots[__builtin_ctz(bits)]);
        const uint32_t settled = leave_start(table, shares, moving, columns.weights, slots);
        for (uint32_t bits = settled; bits != 0; bits &= bits - 1)
            columns.settled[slots[__builtin_ctz(bits)]] = 1;
        return;
    }
    StateWeight from[max_path_states];
    bool found = false;
    for (uint32_t bits = moving; bits != 0; bits &= bits - 1) {
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
            settled &= move_weight(table, from[k], shares, lane, columns.weights, at);
        }
        columns.settled[at] = settled ? 1 : 0;
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
