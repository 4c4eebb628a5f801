// tests/surface/scattering_test.cpp - phase function and free flights against their definitions.
// SPDX-License-Identifier: Apache-2.0
#include "surface/scattering.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::test {
namespace {

/// Integral of Henyey and Greenstein's phase function from cosine -1 to c.
double cumulative(double c, double g) {
    return (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g - 2 * g * c) - 1 / (1 + g));
}

TEST(HenyeyGreenstein, SamplingInvertsTheCumulativeDistribution) {
    for (const double g : {-0.99, -0.5, -0.1, 0.1, 0.5, 0.99}) {
        for (int i = 0; i < 100; ++i) {
            const double u = (i + 0.5) / 100;
            // The greatest cosines come first where light goes backwards.
            const double cosine = sample_henyey_greenstein(g, u);
            EXPECT_NEAR(cumulative(cosine, g), u, 1e-9) << g << ", " << u;
            const auto single =
                sample_henyey_greenstein(static_cast<float>(g), static_cast<float>(u));
            EXPECT_NEAR(static_cast<double>(single), cosine, 2e-4) << g << ", " << u;
        }
    }
    EXPECT_EQ(sample_henyey_greenstein(0.0, 0.25), 0.5);
}

/// The density is 1 in sum, and that of the samples: their share up to each place.
TEST(EquiangularSegment, IsTheDensityOfItsSamples) {
    for (const EquiangularSegment<double>& segment : {EquiangularSegment<double>{1.5, 0.3, 4},
                                                      EquiangularSegment<double>{-2, 0.5, 3},
                                                      EquiangularSegment<double>{9, 0.001, 3},
                                                      EquiangularSegment<double>{2, 1e-4, 4},
                                                      EquiangularSegment<double>{1, 500, 2}}) {
        constexpr int steps = 4000;
        double before = 0;
        double sum = 0;
        for (int i = 1; i < steps; ++i) {
            const double u = static_cast<double>(i) / steps;
            const double here = segment.sample(u);
            ASSERT_GE(here, before);
            const double middle = segment.sample(u - 0.5 / steps);
            const double mean =
                (segment.pdf(before) + 4 * segment.pdf(middle) + segment.pdf(here)) / 6;
            sum += mean * (here - before);
            if (i > 4 && i + 4 < steps) {
                ASSERT_NEAR(mean * (here - before) * steps, 1, 0.02)
                    << segment.aside_m << ", " << u;
            }
            before = here;
        }
        EXPECT_NEAR(sum, 1, 0.01);
        EXPECT_EQ(segment.pdf(segment.end_m * 1.001), 0);
        const EquiangularSegment<float> single{static_cast<float>(segment.ahead_m),
                                               static_cast<float>(segment.aside_m),
                                               static_cast<float>(segment.end_m)};
        const double half = segment.sample(0.5);
        EXPECT_NEAR(static_cast<double>(single.sample(0.5f)), half, 1e-4 * half);
        EXPECT_NEAR(static_cast<double>(single.pdf(single.sample(0.5f))),
                    segment.pdf(half),
                    2e-3 * segment.pdf(half));
    }
}

TEST(HenyeyGreenstein, DirectionsAreUnitAndTurnByTheSampledCosine) {
    const Vec3d from = normalize(Vec3d{0.3, -0.8, 0.2});
    for (int i = 0; i < 64; ++i) {
        const Vec2<double> u{(i + 0.5) / 64, std::fmod(i * 0.618, 1.0)};
        const Vec3d to = scatter_direction(from, 0.4, u);
        EXPECT_NEAR(dot(to, to), 1, 1e-12);
        EXPECT_NEAR(dot(to, from), sample_henyey_greenstein(0.4, u.x), 1e-12);
    }
}

/// Integral 1 over all directions, mean cosine g, and the density of what is sampled.
TEST(HenyeyGreenstein, IsTheDensityOfItsSamples) {
    for (const double g : {-0.9, -0.3, 0.0, 0.0005, 0.5, 0.95}) {
        SCOPED_TRACE(g);
        constexpr int steps = 200000;
        double sum = 0;
        double cosines = 0;
        for (int i = 0; i < steps; ++i) {
            const double cosine = -1 + 2 * (i + 0.5) / steps;
            const double value = henyey_greenstein(g, cosine) * 2 * pi_d * 2 / steps;
            sum += value;
            cosines += value * cosine;
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        EXPECT_NEAR(cosines, std::abs(g) < 1e-3 ? 0 : g, 1e-5);
        for (int i = 1; i < 100; ++i) {
            // A sample's density is one over how much its number changes the cosine.
            const double u = i / 100.0;
            const double step = 1e-5;
            const double change =
                sample_henyey_greenstein(g, u - step) - sample_henyey_greenstein(g, u + step);
            const double density = henyey_greenstein(g, sample_henyey_greenstein(g, u));
            EXPECT_NEAR(density * 2 * pi_d * std::abs(change) / (2 * step), 1, 1e-4) << u;
            const auto cosine = static_cast<float>(sample_henyey_greenstein(g, u));
            const auto single =
                static_cast<double>(henyey_greenstein(static_cast<float>(g), cosine));
            EXPECT_NEAR(single / density, 1, 1e-3) << u;
        }
    }
}

/// Means of both weights over all random numbers: light that scatters before the surface, and light
/// that arrives at it.
TEST(FreeFlight, WeightsMeanWhatBeerAndLambertSay) {
    const Vec3d extinction{0.4, 2.5, 0.0};
    const Vec3d albedo{0.5, 1.0, 1.0};
    const Vec3d share{0.6, 0.3, 0.1};
    const double limit = 1.3;
    constexpr int steps = 1000;
    Vec3d scattered{0, 0, 0};
    Vec3d passed{0, 0, 0};
    for (int i = 0; i < steps; ++i) {
        for (int k = 0; k < steps; ++k) {
            const Vec2<double> u{(i + 0.5) / steps, (k + 0.5) / steps};
            const FreeFlight<double> f = sample_flight(extinction, albedo, share, limit, u);
            if (f.distance_m < limit) {
                scattered = scattered + f.scattered;
            } else {
                passed = passed + f.passed;
            }
        }
    }
    const double all = static_cast<double>(steps) * steps;
    const auto through = [&](double sigma) { return std::exp(-sigma * limit); };
    EXPECT_NEAR(passed.x / all, through(0.4), 1e-3);
    EXPECT_NEAR(passed.y / all, through(2.5), 1e-3);
    EXPECT_NEAR(passed.z / all, 1, 1e-3);
    EXPECT_NEAR(scattered.x / all, 0.5 * (1 - through(0.4)), 1e-3);
    EXPECT_NEAR(scattered.y / all, 1 - through(2.5), 1e-3);
    EXPECT_EQ(scattered.z, 0);
}

TEST(SingleScatterAlbedo, GrowsFromBlackToWhite) {
    EXPECT_NEAR(single_scatter_albedo(0), 0, 1e-5);  // the fit's own digits
    EXPECT_NEAR(single_scatter_albedo(1), 1, 1e-5);
    double last = 0;
    for (int i = 1; i <= 100; ++i) {
        const double albedo = single_scatter_albedo(i / 100.0);
        EXPECT_GT(albedo, last);
        EXPECT_GT(albedo, i / 100.0 - 1e-5) << "many scatterings darken";
        last = albedo;
    }
}

}  // namespace
}  // namespace obscura::test
