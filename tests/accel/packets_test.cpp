// tests/accel/packets_test.cpp - packets of 16 rays in, hits out, on every instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "accel/packets.h"

#include "accel/accel_scenes.h"
#include "accel/dispatch.h"
#include "accel/safe_ray.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace obscura::test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr size_t padded = 40;
constexpr RayReach reach = {1.6e18f, 1.75e18f};

/// Safe rays, all different.
struct Rays {
    Rays() {
        Pcg32 random(8);
        for (std::vector<float>& column : columns)
            for (float& value : column)
                value = 0.1f + random.next_float();
    }
    RayColumns view(bool with_end, bool with_time) const {
        return {columns[0].data(),
                columns[1].data(),
                columns[2].data(),
                columns[3].data(),
                columns[4].data(),
                columns[5].data(),
                with_end ? columns[6].data() : nullptr,
                nullptr,
                static_cast<int>(padded),
                with_time ? columns[7].data() : nullptr};
    }

    /// Origin, direction, end and time.
    std::array<std::vector<float>, 8> columns = {std::vector<float>(padded),
                                                 std::vector<float>(padded),
                                                 std::vector<float>(padded),
                                                 std::vector<float>(padded),
                                                 std::vector<float>(padded),
                                                 std::vector<float>(padded),
                                                 std::vector<float>(padded),
                                                 std::vector<float>(padded)};
};

class Packets : public testing::TestWithParam<Isa> {
protected:
    static const PacketMoves& moves() {
        constexpr const char* names[] = {"sse4.2", "avx2", "avx512"};
        return *accel_functions_for(names[static_cast<size_t>(GetParam()) - 1]).packets;
    }
};

INSTANTIATE_TEST_SUITE_P(EveryIsa, Packets, testing::ValuesIn(all_isas()), [](const auto& isa) {
    return stage_table_for(isa.param).isa;
});

TEST_P(Packets, RaysArriveAsTheyAre) {
    const Rays rays;
    for (const int first : {0, 1, 16, 24}) {
        for (const bool extras : {false, true}) {
            RTCRay16 out;
            begin_packets(out);
            ASSERT_TRUE(moves().load(rays.view(extras, extras), first, reach, out));
            for (int i = 0; i < packet; ++i) {
                const auto index = static_cast<size_t>(first + i);
                const float got[] = {out.org_x[i],
                                     out.org_y[i],
                                     out.org_z[i],
                                     out.dir_x[i],
                                     out.dir_y[i],
                                     out.dir_z[i]};
                for (size_t c = 0; c < 6; ++c)
                    EXPECT_EQ(got[c], rays.columns[c][index]);
                EXPECT_EQ(out.tfar[i], extras ? rays.columns[6][index] : unlimited);
                EXPECT_EQ(out.time[i], extras ? rays.columns[7][index] : 0.0f);
                EXPECT_EQ(out.id[i], static_cast<unsigned>(index));
                EXPECT_EQ(out.tnear[i], 0.0f);
                EXPECT_EQ(out.mask[i], 0xFFFFFFFFU);
            }
        }
    }
}

/// Refused rays are the same as one by one, in every lane.
TEST_P(Packets, OneUnsafeRayRefusesThePacket) {
    const float values[] = {
        nan, infinity, -infinity, 1.9e18f, -1.9e18f, 1.7e18f, 0.0f, -0.0f, -1.0f};
    for (size_t column = 0; column < 7; ++column) {
        for (const float value : values) {
            for (int lane = 0; lane < packet; ++lane) {
                Rays rays;
                const int index = 5 + lane;
                rays.columns[column][static_cast<size_t>(index)] = value;
                RTCRay16 out;
                const bool safe = is_safe(rays.view(true, false), index, reach);
                EXPECT_EQ(moves().load(rays.view(true, false), 5, reach, out), safe)
                    << value << " in column " << column << ", lane " << lane;
            }
        }
    }
    Rays rays;  // no direction at all
    for (size_t c = 3; c < 6; ++c)
        rays.columns[c][9] = 0;
    RTCRay16 out;
    EXPECT_FALSE(moves().load(rays.view(false, false), 0, reach, out));
    EXPECT_TRUE(moves().load(rays.view(false, false), 10, reach, out));
}

TEST_P(Packets, HitsOfValidLanesAreStored) {
    RTCRayHit16 block;
    ValidMask valid;
    for (unsigned i = 0; i < packet; ++i) {
        block.ray.tfar[i] = static_cast<float>(i) + 0.5f;
        block.hit.u[i] = static_cast<float>(i) * 0.01f;
        block.hit.v[i] = static_cast<float>(i) * 0.02f;
        block.hit.primID[i] = 100 + i;
        block.hit.geomID[i] = i % 3 == 0 ? RTC_INVALID_GEOMETRY_ID : i;
        valid.lane[i] = i % 5 == 0 ? 0 : -1;
    }
    std::vector<float> t(padded, -7), u(padded, -7), v(padded, -7);
    std::vector<int32_t> instance(padded, -7), primitive(padded, -7), triangle(padded, -7);
    const HitColumns hits{
        t.data(), u.data(), v.data(), instance.data(), primitive.data(), triangle.data()};
    moves().store(block, valid, hits, 3);
    for (size_t index = 0; index < padded; ++index) {
        const bool inside = index >= 3 && index < 3 + packet;
        const size_t i = index - 3;
        const bool hit = inside && i % 3 != 0 && i % 5 != 0;
        EXPECT_EQ(primitive[index], !inside ? -7 : hit ? static_cast<int32_t>(i) : -1) << index;
        EXPECT_EQ(instance[index], inside ? -1 : -7) << index;
        if (!hit) continue;
        EXPECT_EQ(t[index], static_cast<float>(i) + 0.5f);
        EXPECT_EQ(u[index], static_cast<float>(i) * 0.01f);
        EXPECT_EQ(v[index], static_cast<float>(i) * 0.02f);
        EXPECT_EQ(triangle[index], 100 + static_cast<int32_t>(i));
    }
}

}  // namespace
}  // namespace obscura::test
