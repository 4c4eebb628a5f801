// tests/support/lane_arrays.h - lanes as arrays of plain numbers, so that tests can look into them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <array>
#include <cstring>

namespace obscura::test {

template <typename T>
using LaneArray = std::array<T, static_cast<size_t>(lane_count)>;

inline LaneArray<float> lane_array(Lanes lanes) {
    LaneArray<float> values;
    store(values.data(), lanes);
    return values;
}
inline LaneArray<int32_t> lane_array(LanesI lanes) {
    LaneArray<int32_t> values;
    store(values.data(), lanes);
    return values;
}
inline LaneArray<uint32_t> lane_array(LanesU lanes) {
    LaneArray<uint32_t> values;
    store(values.data(), lanes);
    return values;
}
inline LaneArray<bool> lane_array(Mask mask) {
    LaneArray<bool> values;
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = (mask_bits(mask) >> i & 1U) != 0;
    return values;
}

/// Lane i as a scalar.
template <typename L>
auto lane(const L& lanes, int i) {
    return lane_array(lanes)[static_cast<size_t>(i)];
}
inline Vec3f lane(const Vec3<Lanes>& v, int i) {
    return {lane(v.x, i), lane(v.y, i), lane(v.z, i)};
}

/// Lanes filled by a function of the lane's number.
template <typename Function>
auto make_lanes(const Function& value_of) {
    using T = decltype(value_of(0));
    LaneArray<T> values;
    for (int i = 0; i < lane_count; ++i)
        values[static_cast<size_t>(i)] = value_of(i);
    return load(values.data());
}

/// A mask with these bits.
inline Mask make_mask(uint32_t bits) {
    return make_lanes([&](int i) { return static_cast<int32_t>(bits >> i & 1U); }) != LanesI(0);
}

/// The same number to the last bit; all NaN are alike.
inline bool same_number(float a, float b) {
    return (a != a && b != b) || std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace obscura::test
