// stages/light_path_state.cpp - the memory of light layers, and what happens to it between stages.
// SPDX-License-Identifier: Apache-2.0
#include "stages/light_path_state.h"

#include "stages/pixel_sum.h"
#include "surface/lobe_shares.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obscura {

namespace {

constexpr size_t color_words = size_t{3} * padded_slots;

/// Numbers of shadows_.
constexpr uint16_t unshadowed_number = 0;
constexpr uint16_t shadowed_number = 1;

/// The settled state for which a state's weight of a settled path counts, or no_common_state.
uint16_t settled_state(const LightPathTable& table, uint16_t state) {
    return table.settled[state] != 0 ? state : table.common_next[state];
}

/// The layers that a state's part of a class's light belongs to.
std::span<const uint16_t> layers_of_class(const LightPathTable& table,
                                          uint16_t state,
                                          uint32_t light_class) {
    const size_t row = size_t{state} * table.class_count + light_class;
    return {table.layers + table.layer_begin[row], table.layers + table.layer_begin[row + 1]};
}

}  // namespace

void LightPathState::Colors::begin(int numbers) {
    const auto size = static_cast<size_t>(numbers);
    if (is_used.size() != size) {
        memory.resize(size * color_words);
        is_used.assign(size, 0);
        used.resize(size);
        used_count = 0;
    }
    for (int k = 0; k < used_count; ++k)
        is_used[used[static_cast<size_t>(k)]] = 0;
    used_count = 0;
}

ColorColumns LightPathState::Colors::view() {
    return {memory.data(), is_used.data(), used.data(), &used_count};
}

ColorView LightPathState::Colors::color(size_t number) const {
    if (number >= is_used.size() || is_used[number] == 0) return {};
    const float* red = memory.data() + number * color_words;
    return {red, red + padded_slots, red + size_t{2} * padded_slots};
}

void LightPathState::begin(const LightPathTable& table,
                           int count,
                           bool goes_straight,
                           bool catches) {
    count_ = count;
    bounces_ = 0;
    has_moved_ = false;
    weights_.begin(table.state_count);
    shadow_weights_.begin(table.state_count);
    layers_.begin(table.layer_count);
    sums_.begin(table.sum_count);
    resting_sums_.begin(table.resting_sum_count);
    shadow_sums_.begin(table.resting_sum_count);
    shadows_.begin(table.shadow ? 2 : 0);
    behind_.begin(catches ? table.layer_count : 0);
    held_.clear();
    words_.resize(size_t{3} * padded_slots);
    columns_ = {.table = &table,
                .weights = weights_.view(),
                .shadow_weights = shadow_weights_.view(),
                .layers = layers_.view(),
                .sums = sums_.view(),
                .resting_sums = resting_sums_.view(),
                .shadow_sums = shadow_sums_.view(),
                .progress = words_.data(),
                .shadow_split = words_.data() + padded_slots,
                .shadow_class = words_.data() + size_t{2} * padded_slots,
                .goes_straight = goes_straight};
    shadow_columns_ = shadows_.view();
    std::fill_n(columns_.progress, count, table.settled[0] != 0 ? path_settled : path_moves);
    std::fill_n(columns_.shadow_split, count, 0U);
    std::fill_n(use_color(columns_.weights, 0), color_words, 1.0f);
    notes_shadows_ = false;
}

void LightPathState::begin_bounce() {
    columns_.all_at_start = bounces_++ == 0 && !has_moved_;
    forget_shadows();
}

void LightPathState::begin_flight() {
    notes_shadows_ = false;
    forget_shadows();
}

std::array<LightPathState::RestingLight, 3> LightPathState::resting_light() {
    const LightPathTable& table = *columns_.table;
    return {{{weights_, sums_, table.class_of_sum, true},
             {weights_, resting_sums_, table.class_of_resting_sum, false},
             {shadow_weights_, shadow_sums_, table.class_of_resting_sum, false}}};
}

void LightPathState::forget_shadows() {
    if (shadow_weights_.used_count == 0) return;
    const LightPathTable& table = *columns_.table;
    share_out({shadow_weights_, shadow_sums_, table.class_of_resting_sum, false});
    shadow_sums_.begin(table.resting_sum_count);
    shadow_weights_.begin(table.state_count);
    std::fill_n(columns_.shadow_split, count_, 0U);
}

void LightPathState::add_path_light(uint32_t slot, uint32_t light_class, const Vec3f& radiance) {
    if (columns_.progress[slot] == path_settled) {
        add_settled_light(columns_, {slot, light_class, radiance});
    } else {
        add_light(columns_, columns_.weights, {slot, light_class, radiance});
    }
}

void LightPathState::add_shadow_light(uint32_t slot, const Vec3f& radiance) {
    const uint32_t light_class = columns_.shadow_class[slot];
    if (columns_.shadow_split[slot] != 0) {
        add_light(columns_, columns_.shadow_weights, {slot, light_class, radiance});
    } else {
        add_settled_light(columns_, {slot, light_class, radiance});
    }
    if (notes_shadows_) note_shadow_light(slot, radiance);
}

void LightPathState::note_shadow_light(uint32_t slot, const Vec3f& radiance) {
    add_color(shadow_columns_, shadowed_number, slot, radiance);
}

void LightPathState::move(const ColorColumns& weights, uint32_t slot, size_t event) {
    const LightPathTable& table = *columns_.table;
    // A chain of moves may end in a state that comes later in the list: each part moves once.
    std::vector<std::pair<uint16_t, Vec3f>> parts;
    for (int k = 0; k < *weights.used_count; ++k) {
        const uint16_t state = weights.used[k];
        if (table.settled[state] != 0) continue;
        const Vec3f part = color_at(weights.memory + color_words * state, slot);
        if (max_component(part) <= 0) continue;
        parts.emplace_back(state, part);
        clear_color(weights, state, slot);
    }
    for (const auto& [state, part] : parts)
        add_color(weights, table.next[state * scatter_event_count + event], slot, part);
}

void LightPathState::move_path(uint32_t slot, size_t event) {
    if (columns_.progress[slot] == path_settled) return;
    has_moved_ = true;
    share_out({weights_, resting_sums_, columns_.table->class_of_resting_sum, false}, slot);
    move(columns_.weights, slot, event);
    const LightPathTable& table = *columns_.table;
    bool settled = true;
    for (int k = 0; k < *columns_.weights.used_count; ++k) {
        const uint16_t state = columns_.weights.used[k];
        if (table.settled[state] != 0) continue;
        settled &=
            max_component(color_at(columns_.weights.memory + color_words * state, slot)) <= 0;
    }
    columns_.progress[slot] = settled ? path_settled : path_moves;
}

void LightPathState::move_shadow(uint32_t slot, size_t event) {
    if (columns_.shadow_split[slot] == 0) return;
    share_out({shadow_weights_, shadow_sums_, columns_.table->class_of_resting_sum, false}, slot);
    move(columns_.shadow_weights, slot, event);
}

/// In      state_after: of the shadow ray, by the path's
template <typename StateAfter>
void LightPathState::split_shadow(uint32_t slot, const StateAfter& state_after) {
    columns_.shadow_split[slot] = 1;
    for (int k = 0; k < *columns_.weights.used_count; ++k) {
        const uint16_t state = columns_.weights.used[k];
        const Vec3f part = color_at(columns_.weights.memory + color_words * state, slot);
        if (max_component(part) <= 0) continue;
        add_color(columns_.shadow_weights, state_after(state), slot, part);
    }
}

void LightPathState::split_shadow_after(uint32_t slot, size_t event) {
    if (columns_.progress[slot] == path_settled) return;
    const LightPathTable& table = *columns_.table;
    split_shadow(slot, [&](uint16_t state) {
        return table.settled[state] != 0 ? state : table.next[state * scatter_event_count + event];
    });
}

void LightPathState::split_moved_shadow(uint32_t slot) {
    if (columns_.progress[slot] == path_settled) return;
    split_shadow(slot, [](uint16_t state) { return state; });
}

void LightPathState::split_straight_shadow(uint32_t slot) {
    if (columns_.progress[slot] != path_settles_next || columns_.shadow_split[slot] != 0) return;
    split_shadow(slot, [&](uint16_t state) { return columns_.table->common_next[state]; });
}

void LightPathState::add_unshadowed(uint32_t slot, const Vec3f& radiance) {
    add_color(shadow_columns_, unshadowed_number, slot, radiance);
}

/// Light of all samples goes to its layers.
void LightPathState::share_out(const RestingLight& light) {
    const LightPathTable& table = *columns_.table;
    const auto count = static_cast<size_t>(count_);
    for (int q = 0; q < light.weights.used_count; ++q) {
        const uint16_t at = light.weights.used[static_cast<size_t>(q)];
        const uint16_t state = light.at_settled_paths ? settled_state(table, at) : at;
        if (state == no_common_state) continue;
        for (int k = 0; k < light.sums.used_count; ++k) {
            const uint16_t sum = light.sums.used[static_cast<size_t>(k)];
            for (const uint16_t number : layers_of_class(table, state, light.class_of_sum[sum])) {
                float* const layer = use_color(columns_.layers, number);
                const float* weight = light.weights.memory.data() + color_words * at;
                const float* arrived = light.sums.memory.data() + color_words * sum;
                for (size_t c = 0; c < color_words; c += padded_slots) {
                    for (size_t slot = 0; slot < count; ++slot)
                        layer[c + slot] += weight[c + slot] * arrived[c + slot];
                }
            }
        }
    }
}

/// Light of one sample, whose weights may change, goes to its layers.
void LightPathState::share_out(const RestingLight& light, uint32_t slot) {
    const LightPathTable& table = *columns_.table;
    for (int q = 0; q < light.weights.used_count; ++q) {
        const uint16_t at = light.weights.used[static_cast<size_t>(q)];
        const uint16_t state = light.at_settled_paths ? settled_state(table, at) : at;
        if (state == no_common_state) continue;
        const Vec3f weight = color_at(light.weights.memory.data() + color_words * at, slot);
        for (int k = 0; k < light.sums.used_count; ++k) {
            const uint16_t sum = light.sums.used[static_cast<size_t>(k)];
            const Vec3f arrived = color_at(light.sums.memory.data() + color_words * sum, slot);
            for (const uint16_t layer : layers_of_class(table, state, light.class_of_sum[sum]))
                add_color(columns_.layers, layer, slot, weight * arrived);
        }
    }
    for (int k = 0; k < light.sums.used_count; ++k)
        clear_color(light.sums.view(), light.sums.used[static_cast<size_t>(k)], slot);
}

void LightPathState::share_out(uint32_t slot) {
    for (const RestingLight& light : resting_light())
        share_out(light, slot);
}

void LightPathState::move_behind(uint32_t slot) {
    share_out(slot);
    const ColorColumns behind = behind_.view();
    for (int k = 0; k < layers_.used_count; ++k) {
        const uint16_t layer = layers_.used[static_cast<size_t>(k)];
        add_color(behind, layer, slot, color_at(layers_.memory.data() + color_words * layer, slot));
        clear_color(columns_.layers, layer, slot);
    }
}

void LightPathState::add_behind(uint32_t slot, uint32_t light_class, const Vec3f& radiance) {
    const LightPathTable& table = *columns_.table;
    const ColorColumns behind = behind_.view();
    const bool is_settled = columns_.progress[slot] == path_settled;
    for (int q = 0; q < weights_.used_count; ++q) {
        const uint16_t left = weights_.used[static_cast<size_t>(q)];
        const uint16_t state = is_settled ? settled_state(table, left) : left;
        if (state == no_common_state) continue;
        const Vec3f weight = color_at(weights_.memory.data() + color_words * left, slot);
        if (weight.x == 0 && weight.y == 0 && weight.z == 0) continue;
        for (const uint16_t layer : layers_of_class(table, state, light_class))
            add_color(behind, layer, slot, weight * radiance);
    }
}

void LightPathState::hold(uint32_t slot) {
    share_out(slot);
    for (int k = 0; k < weights_.used_count; ++k) {
        const uint16_t state = weights_.used[static_cast<size_t>(k)];
        const Vec3f weight = color_at(weights_.memory.data() + color_words * state, slot);
        if (weight.x == 0 && weight.y == 0 && weight.z == 0) continue;
        held_.push_back({slot, state, weight});
        clear_color(columns_.weights, state, slot);
    }
    // Without a weight, and settled: what arrives is summed, and shared out to nobody.
    columns_.progress[slot] = path_settled;
}

void LightPathState::release(size_t event) {
    const LightPathTable& table = *columns_.table;
    for (const auto& [slot, state, weight] : held_) {
        // Without weights, this only forgets what has arrived since.
        share_out(slot);
        const uint16_t next = table.next[state * scatter_event_count + event];
        add_color(columns_.weights, next, slot, weight);
        if (table.settled[next] == 0) columns_.progress[slot] = path_moves;
    }
    held_.clear();
}

void LightPathState::finish(const SampleView& samples) {
    for (const RestingLight& light : resting_light())
        share_out(light);
    const auto is_usable = [&](size_t slot) {
        return std::fabs(samples.r[slot]) + std::fabs(samples.g[slot]) +
                   std::fabs(samples.b[slot]) <=
               largest_sample;
    };
    // Counted first, which needs no branches: nearly always there are none.
    uint32_t unusable = 0;
    for (size_t slot = 0; slot < static_cast<size_t>(count_); ++slot)
        unusable += is_usable(slot) ? 0U : 1U;
    for (uint32_t slot = 0; slot < static_cast<uint32_t>(count_) && unusable > 0; ++slot) {
        if (is_usable(slot)) continue;
        --unusable;
        for (const ColorColumns& columns : {columns_.layers, shadow_columns_}) {
            for (int k = 0; k < *columns.used_count; ++k)
                clear_color(columns, columns.used[k], slot);
        }
    }
}

ColorView LightPathState::layer(size_t number) const {
    return layers_.color(number);
}

ColorView LightPathState::behind(size_t number) const {
    return behind_.color(number);
}

ColorView LightPathState::unshadowed() const {
    return shadows_.color(unshadowed_number);
}

ColorView LightPathState::shadowed() const {
    return shadows_.color(shadowed_number);
}

}  // namespace obscura
