// tests/statistics/bsdf_test.cpp - the BRDF samples directions with the density it claims.
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

#include <gtest/gtest.h>

#include "support/bsdf_albedo.h"
#include "support/chi_square.h"

namespace obscura {
namespace {

#ifdef OBSCURA_DEBUG
constexpr int sample_count = 50000;
constexpr double wrong_factor = 1.15;  ///< so many samples detect a density this wrong
#else
constexpr int sample_count = 300000;
constexpr double wrong_factor = 1.05;
#endif

constexpr double roughnesses[] = {0.1, 0.3, 0.5, 0.8, 1.0};
constexpr double cosines[] = {1.0, 0.9, 0.6, 0.3, 0.05};
constexpr double metallics[] = {0.0, 0.5, 1.0};
constexpr int test_count = 5 * 5 * 3;
const Vec3d base_color{0.7, 0.5, 0.2};

template <typename F>
BsdfParams<F> cast(const BsdfParams<double>& p) {
    const auto narrow = [](double x) { return F(static_cast<float>(x)); };
    return {{narrow(p.base_color.x), narrow(p.base_color.y), narrow(p.base_color.z)},
            narrow(p.metallic),
            narrow(p.alpha)};
}

BsdfSample<float> draw(const BsdfParams<float>& p, const Vec3d& wo, Pcg32& random) {
    const Vec3f narrow{
        static_cast<float>(wo.x), static_cast<float>(wo.y), static_cast<float>(wo.z)};
    const float x = random.next_float();
    const float y = random.next_float();
    return sample_bsdf(p, narrow, Vec2f{x, y});
}

/// Samples in float against the density in double; `lie` distorts the density to prove the test.
ChiSquareOutcome compare(double metallic, double roughness, double cosine, double lie = 1) {
    const auto p = test::bsdf_of(base_color, metallic, roughness);
    const auto narrow = cast<float>(p);
    const Vec3d wo = test::view_direction(cosine);
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        const BsdfSample<float> s = draw(narrow, wo, random);
        if (!(s.at.pdf > 0)) return std::nullopt;  // below the horizon
        return normalize(Vec3d{s.direction.x, s.direction.y, s.direction.z});
    };
    auto claimed = p;
    claimed.alpha *= lie;
    const LobeWeights<double> lobes = lobe_weights(p, wo.z);
    const auto pdf = [&](const Vec3d& wi) { return evaluate_bsdf(claimed, lobes, wo, wi).pdf; };
    return chi_square_on_sphere(
        sample,
        pdf,
        {.x_bins = 40,
         .y_bins = 40,
         .samples = sample_count,
         .seed = static_cast<uint64_t>(1000 * roughness + 10 * cosine),
         .misses = true,
         .quadrature = {.absolute = 1e-6, .relative = 3e-4, .largest = 1e-4, .min_depth = 2}});
}

void expect_right(double metallic) {
    for (const double roughness : roughnesses) {
        for (const double cosine : cosines) {
            const ChiSquareOutcome outcome = compare(metallic, roughness, cosine);
            EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, test_count)))
                << "metallic " << metallic << ", roughness " << roughness << ", cosine " << cosine
                << ": " << outcome;
        }
    }
}

TEST(BsdfStatistics, DielectricSamplesFollowTheirDensity) {
    expect_right(0.0);
}
TEST(BsdfStatistics, MixedSamplesFollowTheirDensity) {
    expect_right(0.5);
}
TEST(BsdfStatistics, MetalSamplesFollowTheirDensity) {
    expect_right(1.0);
}

TEST(BsdfStatistics, WrongDensityFails) {
    EXPECT_FALSE(compare(1.0, 0.5, 0.6, wrong_factor).passes(0.01));
    EXPECT_FALSE(compare(0.5, 0.8, 0.3, wrong_factor).passes(0.01));
}

/// Mean and standard error of sampled albedo, and the fraction of samples below the horizon.
struct SampledAlbedo {
    double mean, error, lost;
};

SampledAlbedo sampled_albedo(const BsdfParams<double>& p, const Vec3d& wo) {
    const auto narrow = cast<float>(p);
    Pcg32 random(17);
    double sum = 0;
    double squares = 0;
    int lost = 0;
    for (int i = 0; i < sample_count / 2; ++i) {
        const BsdfSample<float> s = draw(narrow, wo, random);
        if (!(s.at.pdf > 0)) {
            ++lost;
            continue;
        }
        const double weight = luminance(s.at.value_cos) / s.at.pdf;
        sum += weight;
        squares += weight * weight;
    }
    const double n = sample_count / 2;
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(squares / n - mean * mean, 0.0) / n), lost / n};
}

TEST(BsdfStatistics, SampledAlbedoIsTheIntegral) {
    for (const double metallic : metallics) {
        for (const double roughness : roughnesses) {
            for (const double cosine : cosines) {
                const auto p = test::bsdf_of(base_color, metallic, roughness);
                const Vec3d wo = test::view_direction(cosine);
                const test::AlbedoResult truth = test::quadrature_albedo(p, wo);
                const SampledAlbedo sampled = sampled_albedo(p, wo);
                EXPECT_NEAR(sampled.mean, luminance(truth.albedo), 4 * sampled.error + 2e-4)
                    << metallic << ", " << roughness << ", " << cosine;
                // The density misses exactly the samples below the horizon.
                const double deviation =
                    std::sqrt(sampled.lost * (1 - sampled.lost) / (sample_count / 2));
                EXPECT_NEAR(1 - truth.pdf, sampled.lost, 4 * deviation + 5e-4)
                    << metallic << ", " << roughness << ", " << cosine;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
