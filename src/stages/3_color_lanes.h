// stages/3_color_lanes.h - colours by number and sample index, of many lanes at once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/column_lanes.h"
#include "stages/light_paths.h"
#include "surface/lobes/list.h"

#include <algorithm>

namespace obscura {
inline namespace OBSCURA_ISA {

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

/// Adds to one colour of the lanes' samples.
OBSCURA_INLINE void add_color_lanes(
    const ColorColumns& columns, uint16_t number, Mask lanes, LanesU slot, const Vec3<Lanes>& add) {
    float* const red = use_color(columns, number);
    float* const green = red + padded_slots;
    add_to_slots(lanes, slot, {{red, add.x}, {green, add.y}, {green + padded_slots, add.z}});
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

/// Colours to be set in the lanes' samples, of several numbers at once.
class NewColors {
public:
    /// Adds to what a number's colour will be, which is 0 at first.
    OBSCURA_INLINE void add(uint16_t number, const Vec3<Lanes>& color) {
        const uint16_t* const found = std::find(numbers_, numbers_ + count_, number);
        ColorLanes& to = colors_[found - numbers_];
        if (found != numbers_ + count_)
            return store_color(Vec3<Lanes>{load(to.r), load(to.g), load(to.b)} + color, to);
        numbers_[count_++] = number;
        store_color(color, to);
    }

    OBSCURA_INLINE void set(const ColorColumns& columns, Mask lanes, LanesU slot) const {
        float* red[max_count];
        for (int k = 0; k < count_; ++k)
            red[k] = use_color(columns, numbers_[k]);
        alignas(64) uint32_t slots[lane_count];
        store(slots, slot);
        for (uint32_t bits = mask_bits(lanes); bits != 0; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            for (int k = 0; k < count_; ++k)
                set_color(red[k] + slots[lane], colors_[k].at(lane));
        }
    }

private:
    static constexpr int max_count = 2 * Lobes::count + 1;

    int count_ = 0;
    uint16_t numbers_[max_count];
    ColorLanes colors_[max_count];
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
