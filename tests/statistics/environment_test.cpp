// tests/statistics/environment_test.cpp - chi-square of environment samples against their density.
// SPDX-License-Identifier: Apache-2.0
#include "light/environment.h"

#include "light/studio.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/environment_maps.h"

namespace obscura {
namespace {

constexpr int test_count = 7;  ///< right densities below

/// Samples in float, as in rendering; the density in double.
ChiSquareOutcome outcome_of(const EnvironmentView& sampled,
                            const EnvironmentView& claimed,
                            int axis,
                            int samples = 1000000) {
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        const uint32_t x = random.next_uint();
        const auto s = sample_environment<float>(sampled, {x, random.next_uint()});
        return Vec3d{s.direction.x, s.direction.y, s.direction.z};
    };
    const auto pdf = [&](const Vec3d& d) { return environment_pdf(claimed, d); };
    return chi_square_on_sphere(sample, pdf, {.samples = samples, .axis = axis});
}

void expect_right(const TestMap& map, double rotation_deg, int axis) {
    const EnvironmentTable table = table_of(map, rotation_deg);
    const ChiSquareOutcome outcome = outcome_of(table.view(), table.view(), axis);
    EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, test_count))) << outcome;
}

TEST(EnvironmentStatistics, NoiseWithAHotPixel) {
    expect_right(noisy_map(40, 20, 1), 0, 1);
}
TEST(EnvironmentStatistics, NoiseTurnedAndSeenFromX) {
    expect_right(noisy_map(48, 24, 2), 123, 0);
}
TEST(EnvironmentStatistics, Sky) {
    expect_right(sky_map(80, 40), 0, 1);
}
TEST(EnvironmentStatistics, OnePixel) {
    expect_right(noisy_map(1, 1, 3), 0, 2);
}
TEST(EnvironmentStatistics, OddSides) {
    expect_right(noisy_map(7, 5, 4), -45, 1);
}

TEST(EnvironmentStatistics, Studio) {
    TestMap map(studio_width, studio_height);
    map.rgb = make_studio_pixels();
    expect_right(map, 0, 1);
}

TEST(EnvironmentStatistics, LanesAreAsRightAsScalars) {
    const EnvironmentTable table = table_of(noisy_map(40, 20, 6), 10);
    const EnvironmentView view = table.view();
    float stored[3][lane_count];
    int used = lane_count;
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        if (used == lane_count) {
            uint32_t bits[2][lane_count];
            for (auto& words : bits) {
                for (uint32_t& word : words)
                    word = random.next_uint();
            }
            const auto s = sample_environment<Lanes>(
                view, {BatchU::load_unaligned(bits[0]), BatchU::load_unaligned(bits[1])});
            s.direction.x.v.store_unaligned(stored[0]);
            s.direction.y.v.store_unaligned(stored[1]);
            s.direction.z.v.store_unaligned(stored[2]);
            used = 0;
        }
        const int i = used++;
        return Vec3d{stored[0][i], stored[1][i], stored[2][i]};
    };
    const auto pdf = [&](const Vec3d& d) { return environment_pdf(view, d); };
    const ChiSquareOutcome outcome = chi_square_on_sphere(sample, pdf, {.axis = 1});
    EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, test_count))) << outcome;
}

TEST(EnvironmentStatistics, WrongDensitiesFail) {
    const TestMap map = noisy_map(40, 20, 1);
    const EnvironmentTable table = table_of(map);
    const EnvironmentTable turned = table_of(map, 1);
    EXPECT_FALSE(outcome_of(table.view(), turned.view(), 1, 200000).passes(0.01));

    TestMap brighter = map;  // one pixel of 800 by a tenth
    for (int channel = 0; channel < 3; ++channel)
        brighter.pixel(13, 5)[channel] *= 1.1F;
    const EnvironmentTable other = table_of(brighter);
    EXPECT_FALSE(outcome_of(table.view(), other.view(), 1, 200000).passes(0.01));
}

}  // namespace
}  // namespace obscura
