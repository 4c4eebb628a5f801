// tests/light/environment_test.cpp - environment look-up: orientation, interpolation, lanes.
// SPDX-License-Identifier: Apache-2.0
#include "light/environment.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/environment_maps.h"
#include <array>
#include <limits>

namespace obscura {
namespace {

Vec3d random_direction(Pcg32& random) {
    const double x = random.next_double();
    return direction_at(x, random.next_double(), 2);
}

template <typename F>
Vec3<F> as(const Vec3d& v) {
    return {static_cast<F>(v.x), static_cast<F>(v.y), static_cast<F>(v.z)};
}

/// The formula of the design, in double and pixel by pixel, independent of the code.
Vec3d reference_radiance(const TestMap& map, const Vec3d& d) {
    const double u = std::atan2(d.z, d.x) / (2 * pi_d) + 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi_d;
    const double x = u * map.width - 0.5;
    const double y = v * map.height - 0.5;
    Vec3d sum{0, 0, 0};
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const int column = static_cast<int>(std::floor(x)) + i;
            const int row = static_cast<int>(std::floor(y)) + j;
            const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
            const float* pixel =
                map.pixel((column + map.width) % map.width, std::clamp(row, 0, map.height - 1));
            sum = sum + Vec3d{pixel[0], pixel[1], pixel[2]} * weight;
        }
    }
    return sum;
}

TEST(Environment, FollowsTheFormula) {
    const TestMap map = noisy_map(37, 19, 5);
    const EnvironmentTable table = table_of(map);
    Pcg32 random(1);
    for (int i = 0; i < 20000; ++i) {
        const Vec3d d = random_direction(random);
        const Vec3d expected = reference_radiance(map, d);
        const Vec3d got = environment_radiance(table.view(), d);
        EXPECT_NEAR(got.x, expected.x, 1e-9 * (1 + expected.x)) << i;
        EXPECT_NEAR(got.y, expected.y, 1e-9 * (1 + expected.y)) << i;
        EXPECT_NEAR(got.z, expected.z, 1e-9 * (1 + expected.z)) << i;
    }
}

TEST(Environment, CentreIsPlusXAndUGrowsTowardsPlusZ) {
    TestMap map(8, 4);
    for (int x = 0; x < 8; ++x) {
        for (int y = 0; y < 4; ++y) {
            map.set(x, y, {static_cast<float>(x), static_cast<float>(y), 0});
        }
    }
    const EnvironmentTable table = table_of(map);
    const auto at = [&](Vec3d d) { return environment_radiance(table.view(), d); };
    EXPECT_NEAR(at({1, 0, 0}).x, 3.5, 1e-12);   // between pixels 3 and 4: the centre
    EXPECT_NEAR(at({0, 0, 1}).x, 5.5, 1e-12);   // a quarter to the right
    EXPECT_NEAR(at({0, 0, -1}).x, 1.5, 1e-12);  // a quarter to the left
    EXPECT_NEAR(at({-1, 0, 0}).x, 3.5, 1e-12);  // the seam: the mean of pixels 7 and 0
    EXPECT_NEAR(at({1, 0, 0}).y, 1.5, 1e-12);
    EXPECT_NEAR(at({0, 1, 0}).y, 0.0, 1e-12);  // row 0 is up
    EXPECT_NEAR(at({0, -1, 0}).y, 3.0, 1e-12);
}

TEST(Environment, RotationIsCounterClockwiseSeenFromAbove) {
    TestMap map(64, 32);
    for (int y = 0; y < 32; ++y)
        map.set(32, y, {1, 1, 1});
    const Vec3d marker = direction_at(0.5 / 64, 0.5, 1);  // centre of column 32
    const Vec3f up_x = environment_radiance(table_of(map).view(), as<float>(marker));
    EXPECT_NEAR(up_x.x, 1, 1e-4);
    const EnvironmentTable turned = table_of(map, 90);  // from +X to -Z
    const Vec3f there =
        environment_radiance(turned.view(), as<float>(Vec3d{marker.z, marker.y, -marker.x}));
    EXPECT_NEAR(there.x, 1, 1e-4);
    EXPECT_EQ(environment_radiance(turned.view(), as<float>(marker)).x, 0);
    const EnvironmentTable far = table_of(map, 90 - 360.0 * 5);
    EXPECT_FLOAT_EQ(far.view().sin_rotation, turned.view().sin_rotation);
}

TEST(Environment, RotationTurnsSamplesToo) {
    const TestMap map = noisy_map(32, 16, 3);
    const EnvironmentTable straight = table_of(map);
    const EnvironmentTable turned = table_of(map, 30);
    const double c = std::cos(pi_d / 6);
    const double s = std::sin(pi_d / 6);
    Pcg32 random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec2<uint32_t> bits{random.next_uint(), random.next_uint()};
        const auto a = sample_environment<double>(straight.view(), bits);
        const auto b = sample_environment<double>(turned.view(), bits);
        EXPECT_NEAR(b.direction.x, c * a.direction.x + s * a.direction.z, 1e-6);
        EXPECT_NEAR(b.direction.z, c * a.direction.z - s * a.direction.x, 1e-6);
        EXPECT_EQ(b.pdf, a.pdf);
        EXPECT_EQ(b.radiance.x, a.radiance.x);
    }
}

TEST(Environment, PolesAndBrokenDirectionsStayInTheMap) {
    const EnvironmentTable table = table_of(noisy_map(16, 8, 2));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float tiny = std::numeric_limits<float>::denorm_min();
    const std::array<Vec3f, 7> directions = {{{0, 1, 0},
                                              {0, -1, 0},
                                              {-0.0F, 1, -0.0F},
                                              {tiny, -1, -tiny},
                                              {-1, 0, -0.0F},
                                              {0, 0, 0},
                                              {nan, nan, nan}}};
    for (size_t i = 0; i < directions.size(); ++i) {
        const Vec3f& d = directions[i];
        const Vec3<Lanes> wide{Lanes(d.x), Lanes(d.y), Lanes(d.z)};
        EXPECT_GE(environment_radiance(table.view(), d).x, 0) << i;
        EXPECT_TRUE(all(environment_radiance(table.view(), wide).x >= Lanes(0.0F))) << i;
        if (i < 5) {
            EXPECT_TRUE(std::isfinite(environment_pdf(table.view(), d))) << i;
            EXPECT_TRUE(all(environment_pdf(table.view(), wide) < Lanes(INFINITY))) << i;
        }
    }
}

/// Float and lanes give what double gives; lanes and float only differ by rounding.
TEST(Environment, FloatDoubleAndLanesAgree) {
    const EnvironmentTable table = table_of(sky_map(256, 128), 20);
    const EnvironmentView view = table.view();
    Pcg32 random(6);
    for (int round = 0; round < 2000; ++round) {
        float d[3][lane_count];
        uint32_t bits[2][lane_count];
        for (int i = 0; i < lane_count; ++i) {
            const Vec3d direction = random_direction(random);
            d[0][i] = static_cast<float>(direction.x);
            d[1][i] = static_cast<float>(direction.y);
            d[2][i] = static_cast<float>(direction.z);
            for (auto& word : bits)
                word[i] = random.next_uint();
        }
        const Vec3<Lanes> lanes_in{BatchF::load_unaligned(d[0]),
                                   BatchF::load_unaligned(d[1]),
                                   BatchF::load_unaligned(d[2])};
        const auto looked = environment_radiance(view, lanes_in);
        const auto sampled = sample_environment<Lanes>(
            view, {BatchU::load_unaligned(bits[0]), BatchU::load_unaligned(bits[1])});
        float got[4][lane_count];
        looked.x.v.store_unaligned(got[0]);
        sampled.direction.x.v.store_unaligned(got[1]);
        sampled.radiance.y.v.store_unaligned(got[2]);
        sampled.pdf.v.store_unaligned(got[3]);
        for (int i = 0; i < lane_count; ++i) {
            const Vec2<uint32_t> one_bits{bits[0][i], bits[1][i]};
            const Vec3f one{d[0][i], d[1][i], d[2][i]};
            const float radiance = environment_radiance(view, one).x;
            const double truth = environment_radiance(view, Vec3d{one.x, one.y, one.z}).x;
            const auto f = sample_environment<float>(view, one_bits);
            const auto g = sample_environment<double>(view, one_bits);
            const double slope = truth > 2 ? 0.5 : 1e-4;  // beside the sun rounding moves much
            EXPECT_NEAR(got[0][i], truth, 1e-4 * truth + slope);
            EXPECT_NEAR(radiance, truth, 1e-4 * truth + slope);
            EXPECT_NEAR(got[1][i], g.direction.x, 1e-6);
            EXPECT_NEAR(f.direction.x, g.direction.x, 1e-6);
            EXPECT_NEAR(got[2][i], g.radiance.y, 1e-4 * g.radiance.y + 1);
            EXPECT_NEAR(f.radiance.y, g.radiance.y, 1e-4 * g.radiance.y + 1);
            EXPECT_NEAR(got[3][i], g.pdf, 1e-4 * g.pdf);
            EXPECT_NEAR(f.pdf, g.pdf, 1e-4 * g.pdf);
        }
    }
}

}  // namespace
}  // namespace obscura
