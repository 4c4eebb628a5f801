// tests/statistics/chi_square_test.cpp - the statistical harness: known values; it can fail.
// SPDX-License-Identifier: Apache-2.0
#include "support/chi_square.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(ChiSquare, PValuesAreThoseOfTheTables) {
    EXPECT_NEAR(chi_square_p_value(3.841459, 1), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_p_value(18.307038, 10), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_p_value(23.209251, 10), 0.01, 1e-6);
    EXPECT_NEAR(chi_square_p_value(2.558212, 10), 0.99, 1e-6);
    EXPECT_NEAR(chi_square_p_value(1106.969, 1000), 0.01, 1e-4);
    EXPECT_NEAR(chi_square_p_value(2.0, 2), std::exp(-1.0), 1e-12);  // closed form
    EXPECT_NEAR(chi_square_p_value(3199.33, 3200), 0.5, 1e-3);
}

TEST(ChiSquare, SidakKeepsTheLevelOfTheWhole) {
    EXPECT_NEAR(sidak_alpha(0.01, 1), 0.01, 1e-12);
    EXPECT_NEAR(1 - std::pow(1 - sidak_alpha(0.01, 25), 25), 0.01, 1e-12);
}

TEST(ChiSquare, QuadratureFollowsAJump) {
    const Quadrature quadrature;
    const auto disk = [](double x, double y) { return x * x + y * y < 1 ? 1.0 : 0.0; };
    EXPECT_NEAR(quadrature.integrate(disk, {0, 1, 0, 1}), pi_d / 4, 5e-4);
}

std::optional<Vec3d> uniform_direction(Pcg32& random) {
    const double x = random.next_double();
    return direction_at(x, random.next_double(), 0);
}

std::optional<Vec3d> cosine_direction(Pcg32& random) {
    const double radius = std::sqrt(random.next_double());
    const double turn = 2 * pi_d * random.next_double();
    return Vec3d{radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1 - radius * radius)};
}

double cosine_pdf(const Vec3d& d) {
    return std::max(d.z, 0.0) / pi_d;
}

TEST(ChiSquare, RightDensitiesPass) {
    const auto uniform = [](const Vec3d&) { return 1 / (4 * pi_d); };
    for (int axis = 0; axis < 3; ++axis) {
        const ChiSquareOutcome outcome =
            chi_square_on_sphere(uniform_direction, uniform, {.samples = 200000, .axis = axis});
        EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, 4))) << outcome;
    }
    const ChiSquareOutcome cosine =
        chi_square_on_sphere(cosine_direction, cosine_pdf, {.samples = 200000});
    EXPECT_TRUE(cosine.passes(sidak_alpha(0.01, 4))) << cosine;
}

TEST(ChiSquare, WrongDensitiesFail) {
    const ChiSquareOptions options{.samples = 200000};
    const auto uniform = [](const Vec3d& d) { return d.z > 0 ? 1 / (2 * pi_d) : 0.0; };
    EXPECT_FALSE(chi_square_on_sphere(cosine_direction, uniform, options).passes(0.01));
    const auto too_large = [](const Vec3d& d) { return 1.01 * cosine_pdf(d); };
    EXPECT_FALSE(chi_square_on_sphere(cosine_direction, too_large, options).passes(0.01));
    const auto sharper = [](const Vec3d& d) { return 1.05 * std::pow(cosine_pdf(d), 1.1); };
    EXPECT_FALSE(chi_square_on_sphere(cosine_direction, sharper, options).passes(0.01));
    const auto turned = [](const Vec3d& d) { return cosine_pdf(-d); };
    EXPECT_FALSE(chi_square_on_sphere(cosine_direction, turned, options).passes(0.01));
    const auto broken = [](const Vec3d&) { return std::nan(""); };
    EXPECT_FALSE(chi_square_on_sphere(cosine_direction, broken, options).passes(0.01));
}

TEST(ChiSquare, MissesNeedTheirShareOfTheDensity) {
    const auto half = [](Pcg32& random) -> std::optional<Vec3d> {
        const std::optional<Vec3d> direction = cosine_direction(random);
        return random.next_double() < 0.5 ? direction : std::nullopt;
    };
    const auto half_pdf = [](const Vec3d& d) { return 0.5 * cosine_pdf(d); };
    ChiSquareOptions options{.samples = 200000};
    EXPECT_FALSE(chi_square_on_sphere(half, half_pdf, options).passes(0.01));
    options.misses = true;
    const ChiSquareOutcome right = chi_square_on_sphere(half, half_pdf, options);
    EXPECT_TRUE(right.passes(0.01)) << right;
    EXPECT_FALSE(chi_square_on_sphere(half, cosine_pdf, options).passes(0.01));
}

TEST(ChiSquare, DirectionsThatAreNotUnitFail) {
    const auto longer = [](Pcg32& random) -> std::optional<Vec3d> {
        return *cosine_direction(random) * 1.01;
    };
    EXPECT_FALSE(chi_square_on_sphere(longer, cosine_pdf, {.samples = 1000}).passes(0.01));
}

/// Under the right density p is uniform: neither always small nor always near 1.
TEST(ChiSquare, PIsUniformOverSeeds) {
    int below_half = 0;
    int below_tenth = 0;
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        const auto uniform = [](double, double) { return 1.0; };
        const auto place = [](Pcg32& random) -> std::optional<Vec2<double>> {
            const double x = random.next_double();
            return Vec2<double>{x, random.next_double()};
        };
        ChiSquareOptions options{.x_bins = 10, .y_bins = 10, .samples = 5000, .seed = seed};
        options.quadrature.min_depth = 0;
        const double p = chi_square_on_square(place, uniform, options).p_value;
        below_half += p < 0.5 ? 1 : 0;
        below_tenth += p < 0.1 ? 1 : 0;
    }
    EXPECT_NEAR(below_half, 100, 28);  // 4 standard deviations
    EXPECT_NEAR(below_tenth, 20, 17);
}

}  // namespace
}  // namespace obscura
