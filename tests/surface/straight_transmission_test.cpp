// tests/surface/straight_transmission_test.cpp - thin walls: the limit of the blurred lobe.
// SPDX-License-Identifier: Apache-2.0
#include "surface/lobes/straight_transmission.h"

#include <gtest/gtest.h>

#include "support/layered_materials.h"

namespace obscura {
namespace {

using namespace test;

constexpr double smooth = static_cast<double>(min_ggx_alpha);

/// Light through the lobe that sample_layered draws: mean weight of what leaves behind.
Vec3d through_by_sampling(const LayeredParams<double>& p, const Vec3d& wo) {
    Pcg32 random(3);
    const LayeredWeights<double> weights = layered_weights(p, wo);
    Vec3d sum{0, 0, 0};
#ifdef OBSCURA_DEBUG
    constexpr int samples = 20000;
#else
    constexpr int samples = 400000;
#endif
    for (int i = 0; i < samples; ++i) {
        const Vec3d u = convert<double>(random_point(random));
        const BsdfSample<double> sample = sample_layered(p, weights, wo, u);
        if (!(sample.at.pdf > 0) || sample.direction.z > 0) continue;
        sum = sum + sample.at.value_cos * (1 / sample.at.pdf);
    }
    return sum * (1.0 / samples);
}

TEST(ThinWall, StraightLightIsTheLimitOfTheLobe) {
    LayeredParams<float> layered = clear_glass(min_ggx_alpha, 0);
    layered.base_color = {0.9F, 0.5F, 0.2F};
    layered.metallic = 0.2F;
    layered.transmission = 0.7F;
    layered.coat = 0.6F;
    layered.coat_alpha = 0.1F;
    layered.sheen_color = {0.1F, 0.3F, 0.2F};
    layered.sheen_alpha = 0.3F;
    LayeredParams<double> p = convert<double>(layered);
    p.alpha = {smooth, smooth};
    for (const double cosine : {0.999, 0.7, 0.3}) {
        const Vec3d wo{std::sqrt(1 - cosine * cosine), 0, cosine};
        const Vec3d by_lobe = through_by_sampling(p, wo);
        LayeredWeights<double> weights = layered_weights(p, wo);
        const StraightLight<double> light = take_straight_light(p, wo, weights);
        EXPECT_NEAR(light.transmittance.x, by_lobe.x, 0.01) << cosine;
        EXPECT_NEAR(light.transmittance.y, by_lobe.y, 0.01) << cosine;
        EXPECT_NEAR(light.transmittance.z, by_lobe.z, 0.01) << cosine;
    }
}

/// Nothing goes through twice, and the lobes that stay are sampled with what is left.
TEST(ThinWall, TheLobesThatStayShareTheRest) {
    Pcg32 random(8);
    for (int n = 0; n < 20000; ++n) {
        LayeredParams<double> p = convert<double>(random_layers(random, 0.1F));
        const bool is_thin_wall = n % 2 == 0;
        if (is_thin_wall) p.alpha = {smooth, smooth};
        const Vec3d wo = normalize(convert<double>(direction_above(random, 0.05F)));
        const LayeredWeights<double> before = layered_weights(p, wo);
        LayeredWeights<double> after = before;
        const StraightLight<double> light = take_straight_light(p, wo, after);
        const double rest =
            after.p_diffuse + after.p_diffuse_transmission + after.p_facet + after.p_coat;
        ASSERT_NEAR(rest, 1 - light.probability, 1e-9) << n;
        ASSERT_GE(after.p_facet, 0) << n;
        const bool passes = max_component(light.transmittance) > 0;
        ASSERT_FALSE(passes && (p.solid || !is_smooth(before.through_alpha))) << n;
        ASSERT_EQ(passes, light.probability > 0) << n;
        ASSERT_EQ(after.transmitted, passes ? 0 : before.transmitted) << n;
        ASSERT_LE(max_component(light.transmittance), 1) << n;
    }
}

/// White sheen that reflects everything lets nothing through, and no path is sent that way.
TEST(ThinWall, NothingPassesBelowFullSheen) {
    Pcg32 random(3);
    LayeredParams<double> p = convert<double>(random_layers(random, 0.1F));
    p.solid = false;
    p.alpha = {smooth, smooth};
    p.metallic = 0;
    p.transmission = 1;
    p.sheen_color = {1, 1, 1};
    p.sheen_alpha = 0.01;
    const Vec3d wo = normalize(Vec3d{1, 0, 0.05});
    LayeredWeights<double> w = layered_weights(p, wo);
    ASSERT_EQ(w.below_sheen, 0);
    const double chance = w.p_facet;
    const StraightLight<double> light = take_straight_light(p, wo, w);
    EXPECT_EQ(light.probability, 0);
    EXPECT_EQ(max_component(light.transmittance), 0);
    EXPECT_EQ(w.p_facet, chance);
}

/// A colourless pane of index 1.5: all but 4 % straight on, and more at a slant.
TEST(ThinWall, APaneFollowsSchlick) {
    LayeredParams<double> p = convert<double>(clear_glass(min_ggx_alpha, 0));
    p.alpha = {smooth, smooth};
    p.f0 = {0.04, 0.04, 0.04};
    for (const double cosine : {1.0, 0.8, 0.2}) {
        const Vec3d wo{std::sqrt(1 - cosine * cosine), 0, cosine};
        LayeredWeights<double> weights = layered_weights(p, wo);
        const double expected = 0.96 - 0.96 * std::pow(1 - cosine, 5);
        EXPECT_NEAR(take_straight_light(p, wo, weights).transmittance.y, expected, 1e-12);
    }
}

}  // namespace
}  // namespace obscura
