// stages/light_paths.h - the light of a batch's paths by the states of light path expressions.
// SPDX-License-Identifier: Apache-2.0
//
// One automaton follows paths for all light layers at once (film/path_automaton.h). A surface
// scatters by several lobes; a path draws one direction, in which each lobe has its share of the
// light. A path is therefore in several states at once: for each state, a weight in red, green and
// blue says which part of its throughput came that way. Weights sum to 1. A scattering moves them
// from state to state by the lobes' shares; light that arrives is added, times the weight, to the
// layers that the state and the light belong to. No random number decides: layers that share all
// light add up to the beauty, sample by sample.
//
// A state is settled when no scattering leads out of it. A path whose whole weight is in settled
// states needs no more care: its light is summed, and shared out when the batch ends. So is that of
// a path whose states lead to settled ones whatever the lobe, from its next scattering on: its
// weights stay in the states that it leaves, and count as those of the states that they lead to.
//
// Where weights rest for a while, light is summed too, by what tells it apart in any state: of
// first hits' shadow rays, and of paths from the scattering that leaves them one step before
// settled states to the next one. It is shared out by the weights when these change, or the batch
// ends.
#pragma once

#include "math/vec.h"
#include "stages/path_state.h"

#include <cstdint>

namespace obscura {

/// Which kind of light a path ends with. A light class is kind * group_count + group.
enum class LightKind : uint32_t {
    punctual,   ///< L
    surface,    ///< O: what emits, unlit materials, splats
    background  ///< B: the environment and the background colour
};
inline constexpr uint32_t light_kinds = 3;

/// States of an automaton at most.
inline constexpr int max_path_states = 1024;

/// Lights of one class, from an index of light sampling to the next run.
struct LightClassRun {
    int32_t first_light;
    uint16_t light_class;
};

/// So few runs are looked through; the class of a light among many is a cache miss.
inline constexpr int max_class_runs = 8;

/// The automaton and the layers of all batches, read by number.
struct LightPathTable {
    const uint16_t* next = nullptr;    ///< state by state * scatter_event_count + event
    const uint8_t* settled = nullptr;  ///< by state
    /// By state: the settled one that every lobe leads to, or no_common_state.
    const uint16_t* common_next = nullptr;
    int state_count = 0;
    /// The layers of state * class_count + class are layers[layer_begin[i]] to layer_begin[i + 1].
    const uint32_t* layer_begin = nullptr;
    const uint16_t* layers = nullptr;
    int layer_count = 0;
    /// By light class: number of the sum that settled paths add its light to, or no_light_sum.
    const uint16_t* sum_of_class = nullptr;
    /// A class of each sum, which stands for all of it.
    const uint16_t* class_of_sum = nullptr;
    int sum_count = 0;
    /// The same for light that arrives while weights rest in states that are not settled.
    const uint16_t* resting_sum_of_class = nullptr;
    const uint16_t* class_of_resting_sum = nullptr;
    int resting_sum_count = 0;
    uint32_t group_count = 1;  ///< of lights; the last group is that of all the others
    uint32_t class_count = light_kinds;
    uint32_t environment_group = 0;
    /// Light class by index of light sampling; the same in runs, at least one.
    const uint16_t* class_of_light = nullptr;
    const LightClassRun* class_runs = nullptr;
    int class_run_count = 0;
    /// Groups of emitting surfaces: the lesser one of primitive and instance counts.
    const uint16_t* group_of_primitive = nullptr;
    const uint16_t* group_of_instance = nullptr;
    bool shadow = false;  ///< the shadow layer is asked for: see LightPathState
};

inline constexpr uint16_t no_light_sum = UINT16_MAX;
inline constexpr uint16_t no_common_state = UINT16_MAX;

/// Colours by number and sample index. Those of a number are 0 from its first use in a batch on.
struct ColorColumns {
    float* memory = nullptr;     ///< of number n: r, g, b, each padded_slots long, from 3 n
    uint8_t* is_used = nullptr;  ///< by number
    uint16_t* used = nullptr;    ///< the numbers in use, ascending: sums have one order
    int* used_count = nullptr;
};

/// Length of columns by sample index.
inline constexpr int padded_slots = batch_size + 16;

/// How far a path has come, as LightPathColumns::progress has it.
inline constexpr uint32_t path_moves = 0;
inline constexpr uint32_t path_settled = 1;       ///< its states are, or lead to, settled ones
inline constexpr uint32_t path_settles_next = 2;  ///< moves, and whatever lobe is next settles it

/// Light by state of the paths of one batch.
struct LightPathColumns {
    const LightPathTable* table = nullptr;
    ColorColumns weights;              ///< of the paths, by state
    ColorColumns shadow_weights;       ///< of their shadow rays, where shadow_split
    ColorColumns layers;               ///< what has arrived, by layer
    ColorColumns sums;                 ///< what has arrived at settled paths, by sum
    ColorColumns resting_sums;         ///< at paths that path_settles_next, by resting sum
    ColorColumns shadow_sums;          ///< by first hits' shadow rays, likewise, where shadow_split
    uint32_t* progress = nullptr;      ///< by sample index: path_moves and so on
    uint32_t* shadow_split = nullptr;  ///< likewise: 1 where the shadow ray has weights of its own
    uint32_t* shadow_class = nullptr;  ///< likewise: light class of the shadow ray
    bool all_at_start = false;         ///< no path has left the first state, where its weight is 1
    bool goes_straight = false;        ///< paths may pass thin walls, which no lobe tells of
};

inline namespace OBSCURA_ISA {

/// The columns of a number: red; green and blue follow at padded_slots and twice that.
OBSCURA_INLINE float* use_color(const ColorColumns& columns, uint16_t number) {
    float* const red = columns.memory + size_t{3} * padded_slots * number;
    if (columns.is_used[number] == 0) {
        columns.is_used[number] = 1;
        int at = (*columns.used_count)++;
        for (; at > 0 && columns.used[at - 1] > number; --at)
            columns.used[at] = columns.used[at - 1];
        columns.used[at] = number;
        for (int i = 0; i < 3 * padded_slots; ++i)
            red[i] = 0;
    }
    return red;
}

OBSCURA_INLINE void add_color(const ColorColumns& columns,
                              uint16_t number,
                              uint32_t slot,
                              const Vec3<float>& color) {
    float* const red = use_color(columns, number) + slot;
    red[0] += color.x;
    red[padded_slots] += color.y;
    red[size_t{2} * padded_slots] += color.z;
}

/// In   red: of a number and a slot
OBSCURA_INLINE void set_color(float* red, const Vec3<float>& color) {
    red[0] = color.x;
    red[padded_slots] = color.y;
    red[size_t{2} * padded_slots] = color.z;
}

OBSCURA_INLINE void clear_color(const ColorColumns& columns, uint16_t number, uint32_t slot) {
    set_color(columns.memory + size_t{3} * padded_slots * number + slot, {0, 0, 0});
}

/// Class of the light that a surface emits.
///
/// In   instance: -1 for none
OBSCURA_INLINE uint32_t emitter_class(const LightPathTable& table,
                                      int32_t primitive,
                                      int32_t instance) {
    uint32_t group = table.group_of_primitive[primitive];
    if (instance >= 0 && table.group_of_instance[instance] < group)
        group = table.group_of_instance[instance];
    return static_cast<uint32_t>(LightKind::surface) * table.group_count + group;
}

/// Class of what emits and belongs to no light group, such as splats.
OBSCURA_INLINE uint32_t ungrouped_emitter_class(const LightPathTable& table) {
    return (static_cast<uint32_t>(LightKind::surface) + 1) * table.group_count - 1;
}

/// Class of the environment and the background.
OBSCURA_INLINE uint32_t background_class(const LightPathTable& table) {
    return static_cast<uint32_t>(LightKind::background) * table.group_count +
           table.environment_group;
}

OBSCURA_INLINE Vec3<float> color_at(const float* red, uint32_t slot) {
    return {red[slot], red[padded_slots + slot], red[size_t{2} * padded_slots + slot]};
}

/// Light that arrives at a path, or by its shadow ray.
struct ArrivingLight {
    uint32_t slot;
    uint32_t light_class;
    Vec3<float> radiance;
};

/// Adds light at a path whose weights are settled.
OBSCURA_INLINE void add_settled_light(const LightPathColumns& columns, const ArrivingLight& light) {
    const uint16_t sum = columns.table->sum_of_class[light.light_class];
    if (sum != no_light_sum) add_color(columns.sums, sum, light.slot, light.radiance);
}

/// Adds light to the layers of the states of a path.
///
/// In   weights: columns.weights or columns.shadow_weights
OBSCURA_INLINE void add_light(const LightPathColumns& columns,
                              const ColorColumns& weights,
                              const ArrivingLight& light) {
    const LightPathTable& table = *columns.table;
    for (int k = 0; k < *weights.used_count; ++k) {
        const uint16_t state = weights.used[k];
        const float* red = weights.memory + size_t{3} * padded_slots * state;
        const Vec3<float> weight = color_at(red, light.slot);
        if (weight.x == 0 && weight.y == 0 && weight.z == 0) continue;
        const size_t row = state * table.class_count + light.light_class;
        for (uint32_t i = table.layer_begin[row]; i < table.layer_begin[row + 1]; ++i)
            add_color(columns.layers, table.layers[i], light.slot, weight * light.radiance);
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
