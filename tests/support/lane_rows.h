// tests/support/lane_rows.h - lanes as arrays of plain numbers, so that tests can look into them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <array>
#include <cstring>

namespace obscura::test {

template <typename T>
using LaneRow = std::array<T, static_cast<size_t>(lane_count)>;

inline LaneRow<float> row_of(Lanes lanes) {
    LaneRow<float> row;
    store(row.data(), lanes);
    return row;
}
inline LaneRow<int32_t> row_of(LanesI lanes) {
    LaneRow<int32_t> row;
    store(row.data(), lanes);
    return row;
}
inline LaneRow<uint32_t> row_of(LanesU lanes) {
    LaneRow<uint32_t> row;
    store(row.data(), lanes);
    return row;
}
inline LaneRow<bool> row_of(Mask mask) {
    LaneRow<bool> row;
    for (size_t i = 0; i < row.size(); ++i)
        row[i] = (mask_bits(mask) >> i & 1U) != 0;
    return row;
}

/// Lane i as a scalar.
template <typename L>
auto lane(const L& lanes, int i) {
    return row_of(lanes)[static_cast<size_t>(i)];
}
inline Vec3f lane(const Vec3<Lanes>& v, int i) {
    return {lane(v.x, i), lane(v.y, i), lane(v.z, i)};
}

/// Lanes filled by a function of the lane's number.
template <typename Function>
auto make_lanes(const Function& value_of) {
    using T = decltype(value_of(0));
    LaneRow<T> row;
    for (int i = 0; i < lane_count; ++i)
        row[static_cast<size_t>(i)] = value_of(i);
    return load(row.data());
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
