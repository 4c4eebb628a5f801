// tests/light/punctual_lanes.h - the same light in lanes, in float and in double.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/punctual_sample.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"
#include <span>

namespace obscura::test {

/// Random choices of the lights, at random positions within 2 m of the origin's planes.
///
/// In   tolerance: of the irradiance, relative to one plus its size
inline void expect_lanes_agree(std::span<const PunctualLight> lights,
                               const LightProfileView& profiles,
                               double tolerance) {
    constexpr int rounds = 500;
    Pcg32 random(3);
    for (int round = 0; round < rounds; ++round) {
        LaneArray<int32_t> index;
        std::array<LaneArray<float>, 3> from;
        for (size_t i = 0; i < index.size(); ++i) {
            index[i] = static_cast<int32_t>(random.next_uint() % lights.size());
            for (auto& number : from)
                number[i] = 4 * random.next_float() - 2;
        }
        const auto lanes = sample_punctual<Lanes>(
            lights.data(),
            load(index.data()),
            {load(from[0].data()), load(from[1].data()), load(from[2].data())},
            profiles);
        for (size_t i = 0; i < index.size(); ++i) {
            const Vec3f place{from[0][i], from[1][i], from[2][i]};
            const auto d = sample_punctual<double>(
                lights.data(), index[i], {place.x, place.y, place.z}, profiles);
            const auto f = sample_punctual<float>(lights.data(), index[i], place, profiles);
            const double room = tolerance * (1 + d.irradiance.x);
            EXPECT_NEAR(lane_array(lanes.irradiance.x)[i], d.irradiance.x, room);
            EXPECT_NEAR(f.irradiance.x, d.irradiance.x, room);
            EXPECT_NEAR(lane_array(lanes.direction.y)[i], d.direction.y, 1e-6);
        }
    }
}

}  // namespace obscura::test
