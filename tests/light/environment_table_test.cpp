// tests/light/environment_table_test.cpp - sampling tables: consistency, energy, odd maps, errors.
// SPDX-License-Identifier: Apache-2.0
#include "light/environment_table.h"

#include "light/studio.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/environment_maps.h"
#include <algorithm>
#include <limits>

namespace obscura {
namespace {

Vec2<uint32_t> random_bits(Pcg32& random) {
    const uint32_t x = random.next_uint();
    return {x, random.next_uint()};
}

/// Integral over the sphere of f(direction), by a midpoint rule on the polar angles.
template <typename Function>
double sphere_integral(int rows, const Function& f) {
    double sum = 0;
    for (int y = 0; y < rows; ++y) {
        const double theta = pi_d * (y + 0.5) / rows;
        for (int x = 0; x < 2 * rows; ++x) {
            const double phi = pi_d * (x + 0.5) / rows;
            const Vec3d direction{
                std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            sum += f(direction) * std::sin(theta);
        }
    }
    return sum * (pi_d / rows) * (pi_d / rows);
}

std::vector<TestMap> maps() {
    TestMap studio(studio_width, studio_height);
    studio.rgb = make_studio_pixels();
    return {noisy_map(40, 20, 1), noisy_map(7, 5, 2), sky_map(80, 40), studio, noisy_map(1, 3, 4)};
}

TEST(EnvironmentTable, DensityIntegratesToOne) {
    for (const TestMap& map : maps()) {
        const EnvironmentTable table = table_of(map, 33);
        const int rows = map.height * 12;
        const double got =
            sphere_integral(rows, [&](const Vec3d& d) { return environment_pdf(table.view(), d); });
        EXPECT_NEAR(got, 1, 2e-3) << map.width;
    }
}

TEST(EnvironmentTable, PowerIsTheIntegralOfTheLuminance) {
    for (const TestMap& map : maps()) {
        const EnvironmentTable table = table_of(map, 33);
        const double expected = sphere_integral(map.height * 16, [&](const Vec3d& d) {
            return luminance(environment_radiance(table.view(), d));
        });
        EXPECT_NEAR(table.power() / expected, 1, map.height > 10 ? 5e-3 : 0.1) << map.width;
    }
}

TEST(EnvironmentTable, EstimatorFindsTheWholeMap) {
    for (const TestMap& map : maps()) {
        const EnvironmentTable table = table_of(map, 33);
        const double expected = sphere_integral(map.height * 16, [&](const Vec3d& d) {
            return luminance(environment_radiance(table.view(), d));
        });
        constexpr uint32_t samples = 1 << 18;
        double sum = 0;
        for (uint32_t i = 0; i < samples; ++i) {  // Hammersley's points
            const Vec2<uint32_t> bits{i << 14 | 1U << 13, reverse_bits(i)};
            const auto sample = sample_environment<float>(table.view(), bits);
            sum += luminance(sample.radiance) / sample.pdf;
        }
        EXPECT_NEAR(sum / samples / expected, 1, 5e-3) << map.width;
    }
}

/// A sample's pixel is one of the four that a look-up mixes there, with the same density.
TEST(EnvironmentTable, SamplesAgreeWithLookUps) {
    for (const TestMap& map : maps()) {
        const EnvironmentTable table = table_of(map, 33);
        Pcg32 random(5);
        for (int i = 0; i < 20000; ++i) {
            const auto sample = sample_environment<double>(table.view(), random_bits(random));
            EXPECT_NEAR(dot(sample.direction, sample.direction), 1, 1e-7);
            EXPECT_GT(sample.pdf, 0);
            const auto taps = environment_taps(table.view(), sample.direction);
            bool found = false;
            for (int tap = 0; tap < 4; ++tap) {
                const bool same = taps.radiance[tap].x == sample.radiance.x &&
                                  taps.radiance[tap].y == sample.radiance.y;
                found |= same && std::abs(sample.pdf / taps.pdf[tap] - 1) < 1e-5;
            }
            EXPECT_TRUE(found) << map.width << ", sample " << i;
        }
    }
}

/// Random numbers from a grid: each pixel of a cell gets a fraction equal to its weight.
TEST(EnvironmentTable, OnePixelOfACellIsDrawnByItsWeight) {
    constexpr uint32_t side = 256;
    const EnvironmentTable table = table_of(maps()[0], 33);
    Pcg32 random(6);
    for (int i = 0; i < 20; ++i) {
        const double x = random.next_double();
        const auto cell = environment_cell(table.view(), direction_at(x, random.next_double(), 1));
        const auto taps = environment_taps(table.view(), cell);
        int drawn[4] = {};
        for (uint32_t k = 0; k < side * side; ++k) {
            const uint32_t bits = (k / side * side + side / 2) << 16 | (k % side * side + side / 2);
            const int32_t word = choose_environment_pixel(cell, bits);
            const auto* found = std::find(cell.word, cell.word + 4, word);
            ASSERT_NE(found, cell.word + 4);
            ++drawn[found - cell.word];
        }
        for (int tap = 0; tap < 4; ++tap)
            EXPECT_NEAR(drawn[tap] / double{side * side}, taps.weight[tap], 2.0 / side);
    }
}

/// A hot pixel beside black ones: no sample is far brighter than the others, as no direction's
/// density is less than a tenth of its light's share.
TEST(EnvironmentTable, NoSampleOutshinesTheOthers) {
    TestMap map(64, 32);
    map.set(20, 15, {1000, 1000, 1000});
    map.set(40, 16, {1, 1, 1});
    const EnvironmentTable table = table_of(map);
    Pcg32 random(9);
    for (int i = 0; i < 20000; ++i) {
        const auto sample = sample_environment<double>(table.view(), random_bits(random));
        const double ratio = sample.radiance.x / sample.pdf / table.power();
        EXPECT_GT(ratio, 0.98) << i;
        EXPECT_LT(ratio, 10) << i;
        if (sample.radiance.x > 1) {
            EXPECT_NEAR(ratio, 1, 0.02) << i;
        }
    }
}

TEST(EnvironmentTable, AnEvenMapIsSampledEvenly) {
    TestMap map(32, 16);
    std::fill(map.rgb.begin(), map.rgb.end(), 0.7F);
    const EnvironmentTable table = table_of(map);
    for (const Vec3d& d : {Vec3d{0.6, 0.8, 0}, Vec3d{1, 0, 0}, Vec3d{0, -0.6, 0.8}})
        EXPECT_NEAR(environment_pdf(table.view(), d) * 4 * pi_d, 1, 0.02);
}

/// MIS compensation: what stands out from an even map gets more than its share of the samples.
TEST(EnvironmentTable, LightSamplesGoToWhatStandsOut) {
    TestMap map(32, 16);
    std::fill(map.rgb.begin(), map.rgb.end(), 1.0F);
    for (int x = 8; x < 10; ++x)
        map.set(x, 7, {20, 20, 20});
    const EnvironmentTable table = table_of(map);
    const auto over_share = [&](const Vec3d& d) {
        const double light = luminance(environment_radiance(table.view(), d));
        return environment_pdf(table.view(), d) / (light / table.power());
    };
    const double azimuth = 2 * pi_d * (9.0 / 32 - 0.5);
    const double polar = pi_d * 7.5 / 16;
    const double sine = std::sin(polar);
    EXPECT_GT(over_share({sine * std::cos(azimuth), std::cos(polar), sine * std::sin(azimuth)}),
              1.3);
    EXPECT_LT(over_share({0, -0.8, 0.6}), 0.95);
    EXPECT_GT(over_share({0, -0.8, 0.6}), 0.1);
}

TEST(EnvironmentTable, WhereLightIsThereIsDensity) {
    TestMap map(16, 8);
    map.set(15, 2, {0, 0, 1e-3F});  // pure blue, across the seam
    map.set(4, 7, {1e6F, 0, 0});    // beside it, everything else is faint
    const EnvironmentTable table = table_of(map);
    int lit = 0;
    Pcg32 random(3);
    for (int i = 0; i < 20000; ++i) {
        const double x = random.next_double();
        const Vec3d d = direction_at(x, random.next_double(), 1);
        const auto taps = environment_taps(table.view(), d);
        for (int tap = 0; tap < 4; ++tap) {
            if (max_component(taps.radiance[tap]) > 0 && taps.weight[tap] > 0) {
                ++lit;
                EXPECT_GT(taps.pdf[tap], 0);
            }
        }
    }
    EXPECT_GT(lit, 500);
}

TEST(EnvironmentTable, BlackMapIsNoLight) {
    const EnvironmentTable table = table_of(TestMap(8, 4));
    EXPECT_TRUE(table.black());
    EXPECT_EQ(table.power(), 0);
    Pcg32 random(1);
    for (int i = 0; i < 100; ++i) {
        const auto sample = sample_environment<float>(table.view(), random_bits(random));
        EXPECT_EQ(sample.pdf, 0);
        EXPECT_EQ(max_component(sample.radiance), 0);
        EXPECT_NEAR(length(sample.direction), 1, 1e-5);
        EXPECT_EQ(environment_pdf(table.view(), sample.direction), 0);
    }
    EXPECT_FALSE(table_of(sky_map(8, 4)).black());
}

TEST(EnvironmentTable, BrokenValuesAreRepairedAndCounted) {
    TestMap map(8, 4);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    map.set(1, 1, {nan, -1, 2});
    map.set(2, 1, {infinity, 1e30F, -infinity});
    const EnvironmentTable table = table_of(map);
    EXPECT_EQ(table.repaired_values(), 5);
    EXPECT_TRUE(std::isfinite(table.power()));
    Pcg32 random(1);
    for (int i = 0; i < 1000; ++i) {
        const auto sample = sample_environment<float>(table.view(), random_bits(random));
        EXPECT_TRUE(std::isfinite(sample.pdf) && sample.pdf > 0);
        EXPECT_TRUE(std::isfinite(luminance(sample.radiance)) && sample.radiance.x >= 0);
    }
    EXPECT_EQ(table_of(sky_map(8, 4)).repaired_values(), 0);
}

TEST(EnvironmentTable, IntensityScalesLightAndNotDensity) {
    const TestMap map = sky_map(16, 8);
    const EnvironmentTable once = table_of(map);
    const EnvironmentTable triple = EnvironmentTable::create(map.image(), 3, 0).value();
    EXPECT_NEAR(triple.power() / once.power(), 3, 1e-6);
    const Vec3d d = normalize(Vec3d{0.3, 0.4, 0.5});
    EXPECT_NEAR(
        environment_radiance(triple.view(), d).x / environment_radiance(once.view(), d).x, 3, 1e-6);
    EXPECT_NEAR(environment_pdf(triple.view(), d) / environment_pdf(once.view(), d), 1, 1e-5);
    EXPECT_TRUE(EnvironmentTable::create(map.image(), 0, 0).value().black());
}

/// A sky of 2 above ground of 1. What stands out of half the mean, 0.75, is 1.25 and 0.25.
TEST(EnvironmentTable, CompensationLeavesTheEvenPartToBsdfSamples) {
    TestMap map(16, 8);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 16; ++x) {
            const float grey = y < 4 ? 2.0F : 1.0F;
            map.set(x, y, {grey, grey, grey});
        }
    }
    const auto sky_over_ground = [&](EnvironmentSampling sampling) {
        const auto table = EnvironmentTable::create(map.image(), 1, 0, sampling).value();
        const Vec3d up = normalize(Vec3d{0.3, 0.9, 0.2});
        const Vec3d down = {up.x, -up.y, up.z};
        return environment_pdf(table.view(), up) / environment_pdf(table.view(), down);
    };
    EXPECT_NEAR(sky_over_ground(EnvironmentSampling::compensated), 5, 1e-4);
    EXPECT_NEAR(sky_over_ground(EnvironmentSampling::by_radiance), 2, 1e-4);
}

TEST(EnvironmentTable, RefusesSizesOutOfRange) {
    const float pixel[3] = {1, 1, 1};
    const EnvironmentImage images[] = {
        {0, 1, pixel}, {1, 0, pixel}, {-4, 2, pixel}, {16385, 1, pixel}, {1, 1, nullptr}};
    for (const EnvironmentImage& image : images) {
        const Result<EnvironmentTable> table = EnvironmentTable::create(image, 1, 0);
        ASSERT_FALSE(table) << image.width;
        EXPECT_EQ(table.error().id, "E-ENV-SIZE");
        EXPECT_EQ(table.error().code, ExitCode::bad_resource);
    }
}

TEST(EnvironmentTable, RefusesOptionsThatAreNoNumbers) {
    const TestMap map = sky_map(4, 2);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double options[][2] = {{-1, 0}, {nan, 0}, {INFINITY, 0}, {1, nan}, {1, INFINITY}};
    for (const auto& option : options) {
        const auto table = EnvironmentTable::create(map.image(), option[0], option[1]);
        ASSERT_FALSE(table) << option[0];
        EXPECT_EQ(table.error().id, "E-ENV-OPTION");
        EXPECT_EQ(table.error().code, ExitCode::usage);
    }
}

}  // namespace
}  // namespace obscura
