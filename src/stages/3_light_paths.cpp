// stages/3_light_paths.cpp - moves the weights of paths by the shares of lobes; sorts light in.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_light_paths.h"

#include "stages/3_color_lanes.h"

#include <span>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// The shares of a group's lobes, by lobe: sums have one order.
struct StoredShares {
    Mask exists[Lobes::count];  ///< the other numbers are not set where no lane has any
    Mask singular[Lobes::count];
    ColorLanes share[Lobes::count];

    StoredShares() {
        for (Mask& lanes : exists)
            lanes = Mask(false);
    }
};

/// Stores the shares of the lanes of a mask beside those of other lanes.
OBSCURA_INLINE void store_shares(Mask lanes, const LobeShares<Lanes>& shares, StoredShares& out) {
    for (int k = 0; k < Lobes::count; ++k) {
        if (!shares.is_known[k]) continue;
        Vec3<Lanes> share = shares.share[k];
        Mask singular = shares.singular[k];
        const Mask exists = lanes & (max_component(share) > Lanes(0.0f));
        if (none(exists)) continue;
        ColorLanes& stored = out.share[k];
        if (any(out.exists[k])) {
            share = select(exists, share, {load(stored.r), load(stored.g), load(stored.b)});
            singular = (exists & singular) | ((!exists) & out.singular[k]);
        }
        out.exists[k] = out.exists[k] | exists;
        out.singular[k] = singular;
        store_color(share, stored);
    }
}

void find_shares(Mask lanes, const Scattering& at, StoredShares& out) {
    const ShadingPoint& s = at.s;
    const Mask layered = s.any_layers ? lanes & s.layers.layered : Mask(false);
    const Mask others = lanes & (!layered);
    LobeShares<Lanes> shares;
    // Called once: a second inlined copy might round differently, and bits depend on neighbours.
    if (any(others)) {
        share_bsdf(s.bsdf, s.lobes, at.light, shares);
        store_shares(others, shares, out);
    }
    if (any(layered)) {
        share_layered(s.layers.params, s.layers.weights, at.light, shares);
        store_shares(layered, shares, out);
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
    for (int k = 0; k < Lobes::count; ++k) {
        if ((mask_bits(shares.exists[k]) >> lane & 1U) == 0) continue;
        const bool singular = (mask_bits(shares.singular[k]) >> lane & 1U) != 0;
        const uint16_t next = next_state(table, from.state, k, singular);
        add_color(to, next, scattering.slot, from.weight * shares.share[k].at(lane));
        settled = settled && table.settled[next] != 0;
    }
    return settled;
}

/// The paths that are settled after a move, and those that the next scattering settles.
struct MovedLanes {
    Mask settled;
    Mask settle_next;
};

/// The same from the first state, for all lanes at once.
///
/// Out  to: colours by state
MovedLanes leave_start(const LightPathTable& table,
                       const StoredShares& shares,
                       Mask lanes,
                       NewColors& to) {
    MovedLanes out{lanes, lanes};
    for (int k = 0; k < Lobes::count; ++k) {
        if (none(shares.exists[k] & lanes)) continue;
        const ColorLanes& share = shares.share[k];
        for (const bool singular : {false, true}) {
            const Mask those = singular ? shares.singular[k] : !shares.singular[k];
            const Mask moved = shares.exists[k] & lanes & those;
            if (none(moved)) continue;
            const uint16_t next = next_state(table, 0, k, singular);
            if (table.settled[next] == 0) out.settled = out.settled & (!moved);
            if (table.common_next[next] == no_common_state)
                out.settle_next = out.settle_next & (!moved);
            const Vec3<Lanes> color{load(share.r), load(share.g), load(share.b)};
            to.add(next, select(moved, color, splat3(Lanes(0.0f))));
        }
    }
    return out;
}

/// How far the lanes' paths have come.
struct Progress {
    Mask moves;        ///< not settled
    Mask settle_next;  ///< of these
};

OBSCURA_INLINE Progress progress_of(const LightPathColumns& columns, Mask lanes, LanesU slot) {
    const LanesI at = select(lanes, as_int(slot), LanesI(0));
    const LanesU word = gather<Lanes>(columns.progress, at);
    return {lanes & (word != LanesU(path_settled)), lanes & (word == LanesU(path_settles_next))};
}

OBSCURA_INLINE void set_words(uint32_t* column, Mask lanes, LanesU slot, uint32_t word) {
    store_by_slot(column, lanes, slot, LanesU(word));
}

/// Gives the lanes this word if each state of their paths leads to a settled one, whatever the
/// lobe; the weights stay where they are, see finish. Returns the lanes that may still move: all
/// whose next step is not known, if one of them must.
///
/// In   word: path_settled, or path_settles_next
Mask settle_lanes(const LightPathColumns& columns,
                  const Progress& progress,
                  LanesU slot,
                  uint32_t word) {
    const Mask unknown = progress.moves & (!progress.settle_next);
    const ColorColumns& weights = columns.weights;
    bool all_settle = true;
    for (int k = 0; k < *weights.used_count && any(unknown) && all_settle; ++k) {
        const uint16_t state = weights.used[k];
        if (columns.table->common_next[state] != no_common_state) continue;
        const Vec3<Lanes> weight = color_lanes(weights, state, unknown, slot);
        all_settle = none(max_component(weight) != Lanes(0.0f));
    }
    set_words(columns.progress, all_settle ? progress.moves : progress.settle_next, slot, word);
    return all_settle ? Mask(false) : unknown;
}

/// The same of one path. False: it has not settled.
bool settle_path(const LightPathColumns& columns,
                 std::span<const StateWeight> from,
                 uint32_t slot,
                 uint32_t word) {
    for (const StateWeight& part : from) {
        if (columns.table->common_next[part.state] == no_common_state) return false;
    }
    columns.progress[slot] = word;
    return true;
}

/// Light of one class that arrives at the lanes.
struct ClassLight {
    uint32_t light_class;
    Vec3<Lanes> radiance;
};

/// Adds light at paths that are settled.
void add_settled_light(const LightPathColumns& columns,
                       Mask lanes,
                       LanesU slot,
                       const ClassLight& light) {
    const uint16_t sum = columns.table->sum_of_class[light.light_class];
    if (any(lanes) && sum != no_light_sum)
        add_color_lanes(columns.sums, sum, lanes, slot, light.radiance);
}

/// Adds light of one class to resting sums. False: the class has none.
bool add_resting_light(const LightPathColumns& columns,
                       const ColorColumns& sums,
                       Mask lanes,
                       LanesU slot,
                       const ClassLight& light) {
    const uint16_t sum = columns.table->resting_sum_of_class[light.light_class];
    if (sum == no_light_sum) return false;
    if (any(lanes)) add_color_lanes(sums, sum, lanes, slot, light.radiance);
    return true;
}

/// Adds light of one class to the layers of the states of the lanes' paths.
///
/// In   weights: columns.weights or columns.shadow_weights
void add_weighted_light(const LightPathColumns& columns,
                        const ColorColumns& weights,
                        Mask lanes,
                        LanesU slot,
                        const ClassLight& light) {
    const LightPathTable& table = *columns.table;
    for (int k = 0; k < *weights.used_count; ++k) {
        const uint16_t state = weights.used[k];
        const size_t row = state * table.class_count + light.light_class;
        const uint32_t end = table.layer_begin[row + 1];
        if (table.layer_begin[row] == end) continue;
        const Vec3<Lanes> weight = color_lanes(weights, state, lanes, slot);
        const Mask has = lanes & (max_component(weight) != Lanes(0.0f));
        if (none(has)) continue;
        const Vec3<Lanes> part = weight * light.radiance;
        for (uint32_t i = table.layer_begin[row]; i < end; ++i)
            add_color_lanes(columns.layers, table.layers[i], has, slot, part);
    }
}

/// Adds light of one class to paths.
void add_path_light(const LightPathColumns& columns,
                    Mask lanes,
                    LanesU slot,
                    const ClassLight& light) {
    const LightPathTable& table = *columns.table;
    if (columns.all_at_start && table.settled[0] == 0) {
        for (uint32_t i = table.layer_begin[light.light_class];
             i < table.layer_begin[light.light_class + 1];
             ++i)
            add_color_lanes(columns.layers, table.layers[i], lanes, slot, light.radiance);
        return;
    }
    const Progress progress = progress_of(columns, lanes, slot);
    add_settled_light(columns, lanes & (!progress.moves), slot, light);
    Mask moving = progress.moves;
    if (add_resting_light(columns, columns.resting_sums, progress.settle_next, slot, light))
        moving = moving & (!progress.settle_next);
    if (any(moving)) add_weighted_light(columns, columns.weights, moving, slot, light);
}

/// Calls add(those, class) for the lanes of each light class.
template <typename Add>
OBSCURA_INLINE void by_class(Mask lanes, LanesU classes, const Add& add) {
    while (any(lanes)) {
        alignas(64) uint32_t words[lane_count];
        store(words, classes);
        const uint32_t light_class = words[__builtin_ctz(mask_bits(lanes))];
        const Mask those = lanes & (classes == LanesU(light_class));
        add(those, light_class);
        lanes = lanes & (!those);
    }
}

}  // namespace

void add_emitted_light(const LightPathColumns& columns,
                       Mask lanes,
                       const HitLanes& hit,
                       LanesU slot,
                       const Vec3<Lanes>& radiance) {
    alignas(64) int32_t primitive[lane_count];
    alignas(64) int32_t instance[lane_count];
    alignas(64) uint32_t classes[lane_count] = {};
    store(primitive, hit.primitive);
    store(instance, hit.instance);
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        classes[lane] = emitter_class(*columns.table, primitive[lane], instance[lane]);
    }
    by_class(lanes, load(classes), [&](Mask those, uint32_t light_class) {
        add_path_light(columns, those, slot, {light_class, radiance});
    });
}

void add_background_light(const LightPathColumns& columns,
                          Mask lanes,
                          LanesU slot,
                          const Vec3<Lanes>& radiance) {
    add_path_light(columns, lanes, slot, {background_class(*columns.table), radiance});
}

void add_shadow_layers(const LightPathColumns& columns,
                       int count,
                       const ShadowView& shadows,
                       const uint8_t* occluded) {
    for (int i = 0; i < count; i += lane_count) {
        alignas(64) uint32_t arrives[lane_count] = {};
        for (int lane = 0; lane < lane_count && i + lane < count; ++lane)
            arrives[lane] = occluded[i + lane] == 0 ? 1 : 0;
        const Mask lanes = load(arrives) != LanesU(0U);
        if (none(lanes)) continue;
        const LanesU slot = load(shadows.slot + i);
        const LanesI at = select(lanes, as_int(slot), LanesI(0));
        const Mask split = lanes & (gather<Lanes>(columns.shadow_split, at) != LanesU(0U));
        const Vec3<Lanes> radiance = load3(shadows.r, shadows.g, shadows.b, i);
        const LanesU classes = gather<Lanes>(columns.shadow_class, at);
        by_class(lanes, classes, [&](Mask those, uint32_t light_class) {
            const ClassLight light{light_class, radiance};
            add_settled_light(columns, those & (!split), slot, light);
            const Mask weighted = those & split;
            if (none(weighted)) return;
            if (columns.all_at_start &&
                add_resting_light(columns, columns.shadow_sums, weighted, slot, light))
                return;
            add_weighted_light(columns, columns.shadow_weights, weighted, slot, light);
        });
    }
}

void note_shadow_class(const LightPathColumns& columns, Mask lanes, LanesU slot, LanesI light) {
    const LightPathTable& table = *columns.table;
    if (table.class_run_count <= max_class_runs) {
        LanesU classes(table.class_runs[0].light_class);
        for (int k = 1; k < table.class_run_count; ++k) {
            const LightClassRun& run = table.class_runs[k];
            classes = select(light >= LanesI(run.first_light), LanesU(run.light_class), classes);
        }
        store_by_slot(columns.shadow_class, lanes, slot, classes);
        return;
    }
    alignas(64) uint32_t slots[lane_count];
    alignas(64) int32_t lights[lane_count];
    store(slots, slot);
    store(lights, light);
    for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        columns.shadow_class[slots[lane]] = table.class_of_light[lights[lane]];
    }
}

void scatter_shadow(const LightPathColumns& columns,
                    Mask lanes,
                    LanesU slot,
                    LanesI light,
                    const Scattering& scattering) {
    const LightPathTable& table = *columns.table;
    note_shadow_class(columns, lanes, slot, light);
    const Progress progress = progress_of(columns, lanes, slot);
    if (none(progress.moves)) return;
    StoredShares shares;
    if (columns.all_at_start) {
        find_shares(lanes, scattering, shares);
        NewColors weights;
        leave_start(table, shares, progress.moves, weights);
        weights.set(columns.shadow_weights, progress.moves, slot);
        set_words(columns.shadow_split, progress.moves, slot, 1);
        return;
    }
    // Whatever lobe a path takes next, its shadow ray has the same weights. A path that passes the
    // surface straight on does not settle; its shadow ray gets weights in split_straight_shadows.
    const uint32_t word = columns.goes_straight ? path_settles_next : path_settled;
    const Mask moving = settle_lanes(columns, progress, slot, word);
    if (none(moving)) return;
    alignas(64) uint32_t slots[lane_count];
    store(slots, slot);
    StateWeight from[max_path_states];
    bool found = false;
    for (uint32_t bits = mask_bits(moving); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t at = slots[lane];
        const int count = states_of(columns.weights, at, from);
        if (settle_path(columns, {from, static_cast<size_t>(count)}, at, word)) continue;
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
    const Progress progress = progress_of(columns, lanes, slot);
    if (none(progress.moves)) return;
    StoredShares shares;
    if (columns.all_at_start) {
        find_shares(lanes, scattering, shares);
        NewColors weights;
        weights.add(0, splat3(Lanes(0.0f)));
        const MovedLanes moved = leave_start(table, shares, progress.moves, weights);
        weights.set(columns.weights, progress.moves, slot);
        set_words(columns.progress, moved.settle_next, slot, path_settles_next);
        set_words(columns.progress, moved.settled, slot, path_settled);
        return;
    }
    const Mask moving = settle_lanes(columns, progress, slot, path_settled);
    if (none(moving)) return;
    alignas(64) uint32_t slots[lane_count];
    store(slots, slot);
    StateWeight from[max_path_states];
    bool found = false;
    for (uint32_t bits = mask_bits(moving); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t at = slots[lane];
        const int count = states_of(columns.weights, at, from);
        if (settle_path(columns, {from, static_cast<size_t>(count)}, at, path_settled)) continue;
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
        columns.progress[at] = settled ? path_settled : path_moves;
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
