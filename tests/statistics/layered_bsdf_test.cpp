// tests/statistics/layered_bsdf_test.cpp - samples of every layer follow the density they claim.
// SPDX-License-Identifier: Apache-2.0
#include "surface/layered_bsdf.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/layered_materials.h"

namespace obscura {
namespace {

using namespace test;

constexpr int test_count = 24;
constexpr int sample_count = 200000;

ChiSquareOutcome compare(const LayeredParams<float>& p, const Vec3f& wo, double lie = 1) {
    const LayeredWeights<float> weights = layered_weights(p, wo);
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        const auto s = sample_layered(p, weights, wo, random_point(random));
        if (!(s.at.pdf > 0)) return std::nullopt;
        return normalize(convert<double>(s.direction));
    };
    LayeredParams<double> claimed = convert<double>(p);
    const Vec3d wide = normalize(convert<double>(wo));
    LayeredWeights<double> wide_weights = layered_weights(claimed, wide);
    claimed.alpha.x *= lie;
    wide_weights.through_alpha.x *= lie;
    const auto pdf = [&](const Vec3d& wi) {
        return evaluate_layered(claimed, wide_weights, wide, wi).pdf;
    };
    return chi_square_on_sphere(
        sample,
        pdf,
        {.x_bins = 40,
         .y_bins = 40,
         .samples = sample_count,
         .seed = 7,
         .misses = true,
         .quadrature = {.absolute = 1e-6, .relative = 3e-4, .largest = 1e-4, .min_depth = 2}});
}

const Vec3f steep = normalize(Vec3f{0.3F, -0.2F, 0.9F});
const Vec3f slanted = normalize(Vec3f{-0.8F, 0.3F, 0.4F});

void expect_right(const LayeredParams<float>& p, const char* name) {
    for (const Vec3f& wo : {steep, slanted}) {
        const ChiSquareOutcome outcome = compare(p, wo);
        EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, test_count)))
            << name << ", cosine " << wo.z << ": " << outcome;
    }
}

TEST(LayerStatistics, ReflectingLayers) {
    LayeredParams<float> brushed = plain_layers(0.15F);
    brushed.alpha.x = 0.6F;
    brushed.metallic = 1;
    expect_right(brushed, "anisotropy");
    LayeredParams<float> coated = plain_layers(0.5F);
    coated.coat = 0.8F;
    coated.coat_alpha = 0.2F;
    coated.coat_normal = normalize(Vec3f{0.2F, 0.1F, 1});
    expect_right(coated, "clearcoat");
    LayeredParams<float> cloth = plain_layers(0.7F);
    cloth.sheen_color = {0.9F, 0.5F, 0.2F};
    cloth.sheen_alpha = 0.3F;
    expect_right(cloth, "sheen");
}

TEST(LayerStatistics, LayersThatLetLightThrough) {
    expect_right(clear_glass(0.2F, 0), "thin wall");
    expect_right(clear_glass(0.3F, 1.5F), "into glass");
    expect_right(clear_glass(0.3F, 1 / 1.5F), "out of glass");
    LayeredParams<float> leaf = plain_layers(0.5F);
    leaf.diffuse_transmission = 0.6F;
    expect_right(leaf, "leaf");
}

TEST(LayerStatistics, MixturesThatMicrofacetsMake) {
    LayeredParams<float> stained = clear_glass(0.3F, 1 / 1.5F);
    stained.base_color = {0.1F, 0.02F, 0.9F};
    expect_right(stained, "stained glass from within");
    stained.metallic = 0.4F;
    stained.transmission = 0.6F;
    stained.solid = false;
    expect_right(stained, "half metal, half plastic");
    LayeredParams<float> bubble = clear_glass(0.2F, 1.3F);
    bubble.thin_film.strength = 1;
    bubble.coat = 0.5F;
    bubble.coat_alpha = 0.1F;
    expect_right(bubble, "coated film");
}

TEST(LayerStatistics, Mixtures) {
    Pcg32 random(11);
    for (int n = 0; n < 2; ++n)
        expect_right(random_layers(random, 0.05F), "mixture");
}

TEST(LayerStatistics, WrongDensityFails) {
    EXPECT_FALSE(compare(clear_glass(0.3F, 1.5F), steep, 1.1).passes(0.01));
}

}  // namespace
}  // namespace obscura
