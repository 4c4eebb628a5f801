// tests/surface/layered_bsdf_test.cpp - the layers' energy, limits, symmetry and precision.
// SPDX-License-Identifier: Apache-2.0
#include "surface/layered_bsdf.h"

#include "surface/lobes/straight_transmission.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/layered_materials.h"

namespace obscura {
namespace {

using namespace test;

#ifdef OBSCURA_DEBUG
constexpr int random_cases = 20000;
constexpr int furnace_samples = 20000;
#else
constexpr int random_cases = 1000000;
constexpr int furnace_samples = 200000;
#endif

/// The radiance under a white sky, by sampling, with its standard error.
struct Furnace {
    Vec3d mean{0, 0, 0};
    double error = 0;
};

Furnace white_furnace(const LayeredParams<float>& p,
                      const Vec3f& wo,
                      int samples = furnace_samples) {
    Pcg32 random(5);
    const LayeredWeights<float> weights = layered_weights(p, wo);
    Furnace out;
    double squares = 0;
    for (int i = 0; i < samples; ++i) {
        const auto sample = sample_layered(p, weights, wo, random_point(random));
        if (!(sample.at.pdf > 0)) continue;
        const Vec3f w = sample.at.value_cos * (1.0F / sample.at.pdf);
        out.mean = out.mean + Vec3d{w.x, w.y, w.z};
        squares += square(static_cast<double>(max_component(w)));
    }
    const double n = samples;
    out.mean = out.mean * (1 / n);
    const double most = max_component(out.mean);
    out.error = std::sqrt(std::max(0.0, squares / n - most * most) / n);
    return out;
}

TEST(Layers, WithoutAnyTheyAreTheCoreMaterial) {
    Pcg32 random(1);
    for (int n = 0; n < 20000; ++n) {
        LayeredParams<double> p = convert<double>(plain_layers(0.01F + random.next_float()));
        p.base_color = {0.3, 0.6, random.next_double()};
        p.metallic = n % 3 == 0 ? 0.0 : random.next_double();
        const BsdfParams<double> core{p.base_color, p.metallic, p.alpha.x};
        const Vec3d wo = normalize(convert<double>(direction_above(random, 0.01F)));
        const Vec3d wi = normalize(convert<double>(direction_above(random, 0.01F)));
        const Vec3d here = evaluate_layered(p, layered_weights(p, wo), wo, wi).value_cos;
        const Vec3d there = evaluate_bsdf(core, wo, wi).value_cos;
        ASSERT_NEAR(here.x, there.x, 1e-6 * there.x) << n;
        ASSERT_NEAR(here.z, there.z, 1e-6 * there.z) << n;
    }
}

TEST(Layers, NoMixtureReflectsMoreThanArrives) {
    Pcg32 random(2);
    for (int n = 0; n < 150; ++n) {
        const LayeredParams<float> p = random_layers(random, 0.01F);
        const Vec3f wo = direction_above(random, 0.1F);
        const Furnace sky = white_furnace(p, wo);
        // Tables are interpolated; a thin film's own albedo is taken at the normal's angle.
        const double slack = p.thin_film.strength > 0 ? 0.03 : 0.006;
        EXPECT_LT(max_component(sky.mean), 1 + slack + 3 * sky.error) << n << ", " << wo.z;
    }
}

/// In   slack: for the interpolated tables
void expect_nothing_lost(const LayeredParams<float>& p, double slack, const char* what) {
    for (const float cosine : {1.0F, 0.7F, 0.3F}) {
        for (const float turn : {0.0F, 0.6F, 1.5F}) {
            const float sine = std::sqrt(1 - cosine * cosine);
            const Vec3f wo{sine * std::cos(turn), sine * std::sin(turn), cosine};
            const Furnace sky = white_furnace(p, wo, furnace_samples / 8);
            EXPECT_NEAR(sky.mean.y, 1, slack + 3 * sky.error)
                << what << ", alpha " << p.alpha.x << " " << p.alpha.y << ", eta " << p.eta
                << ", cosine " << cosine << ", turn " << turn;
            if (p.alpha.x == p.alpha.y) break;  // every rotation is alike
        }
    }
}

constexpr float all_roughnesses[] = {0.0F, 0.25F, 0.5F, 0.75F, 1.0F};

TEST(Layers, ClearGlassLosesNothingAtAnyRoughness) {
    for (const float roughness : all_roughnesses) {
        const float alpha = std::max(roughness * roughness, min_ggx_alpha);
        for (const float eta : {1.002F, 1.05F, 1.5F, 2.42F})
            expect_nothing_lost(clear_glass(alpha, eta), 0.005, "into glass");
        for (const float eta : {1 / 1.05F, 1 / 1.5F, 1 / 2.42F})  // a step at the critical angle
            expect_nothing_lost(clear_glass(alpha, eta), 0.007, "out of glass");
    }
}

TEST(Layers, ThinWallsLoseNothingAtAnyRoughness) {
    for (const float roughness : all_roughnesses) {
        LayeredParams<float> p = clear_glass(std::max(roughness * roughness, min_ggx_alpha), 0);
        for (const float eta : {1.0F, 1.2F, 1.5F, 2.0F}) {
            p.eta = eta;
            p.f0 = splat3(normal_reflectance(eta));
            p.f90 = grazing_reflectance(eta);
            p.transmission = 1;
            expect_nothing_lost(p, 0.005, "pane");
            p.transmission = 0.4F;  // the rest is white paint
            expect_nothing_lost(p, 0.005, "painted pane");
        }
    }
}

TEST(Layers, CoatedAndIridescentAndMixedSurfacesLoseNothing) {
    for (const float roughness : all_roughnesses) {
        LayeredParams<float> p = plain_layers(std::max(roughness * roughness, min_ggx_alpha));
        for (const float metallic : {0.0F, 0.5F, 1.0F}) {
            p.metallic = metallic;
            p.coat = 0.8F;
            p.coat_alpha = 0.3F;
            expect_nothing_lost(p, 0.005, "coated");
        }
        p.coat_alpha = p.alpha.x;
        p.alpha = {0.2F, 0.2F};
        expect_nothing_lost(p, 0.005, "under a coat");
        p.coat = 0;
        p.thin_film.strength = 1;  // over a white metal
        expect_nothing_lost(p, 0.005, "filmed");
    }
}

/// Light between facets takes their colour in each channel by itself.
TEST(Layers, ColouredDielectricsReflectAsMetalsOfTheirColour) {
    for (const float roughness : {0.3F, 0.6F, 1.0F}) {
        LayeredParams<float> p = plain_layers(roughness * roughness);
        const Vec3f color{1.0F, 0.34F, 0.05F};
        p.base_color = {0, 0, 0};
        p.f0 = color;
        const Furnace dielectric = white_furnace(p, {0, 0, 1});
        p.base_color = color;
        p.metallic = 1;
        const Furnace metal = white_furnace(p, {0, 0, 1});
        EXPECT_NEAR(dielectric.mean.x, metal.mean.x, 0.003) << roughness;
        EXPECT_NEAR(dielectric.mean.y, metal.mean.y, 0.003) << roughness;
        EXPECT_NEAR(dielectric.mean.z, metal.mean.z, 0.003) << roughness;
    }
}

TEST(Layers, StretchedFacetsLoseNothing) {
    for (const float roughness : {0.25F, 0.5F, 0.75F, 1.0F}) {
        for (const float strength : {0.3F, 0.6F, 1.0F}) {
            LayeredParams<float> p = plain_layers(roughness * roughness);
            p.alpha.x += (1 - p.alpha.x) * strength * strength;
            expect_nothing_lost(p, 0.005, "plastic");
            p.metallic = 1;
            expect_nothing_lost(p, 0.005, "metal");
            p.metallic = 0;
            p.transmission = 1;
            expect_nothing_lost(p, 0.005, "pane");
            p.solid = true;  // round facets stand in for stretched ones there
            expect_nothing_lost(p, strength < 1 ? 0.035 : 0.13, "glass");
        }
    }
}

/// Nothing refracts, so nothing is spread, masked or reflected.
TEST(Layers, RoughGlassOfIndexOneIsNotThere) {
    LayeredParams<float> pane = clear_glass(1, 0);
    pane.eta = 1;
    pane.f0 = splat3(0.0F);
    pane.f90 = grazing_reflectance(1.0F);
    const Vec3f wo = normalize(Vec3f{0.9F, 0.2F, 0.3F});
    LayeredWeights<float> weights = layered_weights(pane, wo);
    EXPECT_EQ(take_straight_light(pane, wo, weights).transmittance.y, 1.0F);
    // Towards it, light through a solid bends ever less.
    LayeredParams<float> solid = clear_glass(1, 1.002F);
    Pcg32 random(31);
    weights = layered_weights(solid, wo);
    for (int n = 0; n < 2000; ++n) {
        const auto sample = sample_layered(solid, weights, wo, random_point(random));
        if (!(sample.at.pdf > 0) || sample.direction.z > 0) continue;
        ASSERT_LT(length(sample.direction + wo), 0.05F);
    }
}

TEST(Layers, WhiteLeavesLoseNothing) {
    LayeredParams<float> p = plain_layers(1);
    p.diffuse_transmission = 0.4F;
    const Furnace sky = white_furnace(p, {0.6F, 0, 0.8F});
    EXPECT_NEAR(sky.mean.y, 1, 0.005);
}

/// From inside a solid the boundary reflects all slanting light; the rest may pass diffusely.
TEST(Layers, WhiteSolidsLoseNothingFromWithin) {
    for (const float eta : {1 / 1.1F, 1 / 1.5F, 1 / 2.4F}) {
        for (const float alpha : {min_ggx_alpha, 0.09F, 0.5F}) {
            LayeredParams<float> p = plain_layers(alpha);
            p.solid = true;
            p.eta = eta;
            p.f0 = splat3(normal_reflectance(eta));
            p.diffuse_transmission = 0.6F;
            for (const float cosine : {0.98F, 0.8F, 0.6F, 0.3F}) {
                const Vec3f wo{std::sqrt(1 - cosine * cosine), 0, cosine};
                EXPECT_NEAR(white_furnace(p, wo).mean.y, 1, 0.03)
                    << "eta " << eta << ", alpha " << alpha << ", cosine " << cosine;
            }
        }
    }
}

TEST(Layers, ACoatDarkensWhatIsUnderIt) {
    LayeredParams<float> p = plain_layers(1);
    p.f0 = splat3(0.0F);
    p.f90 = 0;
    p.coat = 1;
    p.coat_alpha = 0.01F;
    const Vec3f up{0, 0, 1};
    const Vec3f aside = normalize(Vec3f{1, 0, 1});
    const Vec3f value = evaluate_layered(p, layered_weights(p, up), up, aside).value_cos;
    EXPECT_NEAR(value.x, (1 - dielectric_f0) * aside.z / pi_f, 1e-3F);
    EXPECT_NEAR(white_furnace(p, aside).mean.x, 1, 0.005);
}

TEST(Layers, SheenIsTheIntegralOfItsTable) {
    for (const float roughness : {0.3F, 0.5F, 0.8F, 1.0F}) {
        for (const float cosine : {0.9F, 0.5F, 0.2F}) {
            LayeredParams<float> p = plain_layers(1);
            p.base_color = p.f0 = splat3(0.0F);
            p.f90 = 0;
            p.sheen_color = splat3(1.0F);
            p.sheen_alpha = roughness * roughness;
            const Vec3f wo{std::sqrt(1 - cosine * cosine), 0, cosine};
            const Furnace sky = white_furnace(p, wo);
            const float table = sheen_albedo(cosine, p.sheen_alpha).albedo;
            EXPECT_NEAR(sky.mean.x, static_cast<double>(table), 0.004 + 4 * sky.error)
                << roughness << ", " << cosine;
        }
    }
}

/// Glass mixed with metal, tinted, under a thin film: all that only microfacets do.
LayeredParams<float> stained_glass(float alpha, float eta) {
    LayeredParams<float> p = clear_glass(alpha, eta);
    p.base_color = {0.1F, 0.02F, 0.9F};
    p.metallic = 0.3F;
    p.thin_film.strength = 0.7F;
    return p;
}

/// Samples weigh what is left after one masking, G1, times what the microfacet leaves of a channel
/// over what it leaves of the channels' mean, times the light of further bounces.
void expect_bounded_weights(const LayeredParams<float>& p, float bound) {
    constexpr int samples = random_cases / 1000;
    Pcg32 random(12);
    for (const float cosine : {1.0F, 0.8F, 0.6F, 0.3F, 0.1F, 0.03F}) {
        const Vec3f wo{std::sqrt(1 - cosine * cosine), 0, cosine};
        const LayeredWeights<float> weights = layered_weights(p, wo);
        for (int n = 0; n < samples; ++n) {
            const auto sample = sample_layered(p, weights, wo, random_point(random));
            if (!(sample.at.pdf > 0)) continue;
            const float gain = std::max(max_component(weights.dielectric), weights.through_factor) +
                               max_component(weights.metal);
            ASSERT_LT(max_component(sample.at.value_cos) / sample.at.pdf, bound * gain + 1e-4F)
                << "eta " << p.eta << ", alpha " << p.alpha.x << ", cosine " << cosine;
        }
    }
}

TEST(Layers, NoSampleOfGlassWeighsMoreThanItsColour) {
    for (const float alpha : {min_ggx_alpha, 0.01F, 0.1F, 0.4F, 1.0F}) {
        expect_bounded_weights(clear_glass(alpha, 0), 1);
        for (const float eta : {1.001F, 1.5F, 2.4F, 1 / 1.5F, 1 / 2.4F}) {
            expect_bounded_weights(clear_glass(alpha, eta), 1);
            expect_bounded_weights(stained_glass(alpha, eta), 3);
        }
    }
}

TEST(Layers, RandomParametersNeverLeaveTheNumbers) {
    Pcg32 random(3);
    for (int n = 0; n < random_cases; ++n) {
        const LayeredParams<float> p = random_layers(random, min_ggx_alpha);
        const Vec3f wo = direction_above(random, n % 4 == 0 ? 0.0F : 1e-4F);
        const LayeredWeights<float> weights = layered_weights(p, wo);
        const auto sample = sample_layered(p, weights, wo, random_point(random));
        ASSERT_TRUE(std::isfinite(sample.at.pdf) && sample.at.pdf >= 0) << n;
        ASSERT_TRUE(std::isfinite(max_component(sample.at.value_cos))) << n;
        ASSERT_NEAR(length(sample.direction), 1, 1e-3F) << n;
        Vec3f wi = direction_above(random, 0.0F);
        if (n % 2 == 0) wi.z = -wi.z;
        const BsdfValue<float> at = evaluate_layered(p, weights, wo, wi);
        ASSERT_TRUE(std::isfinite(at.pdf) && at.pdf >= 0) << n;
        ASSERT_TRUE(std::isfinite(max_component(at.value_cos))) << n;
        ASSERT_GE(at.value_cos.y, 0.0F) << n;
    }
}

TEST(Layers, PrecisionsAgree) {
    Pcg32 random(4);
    for (int n = 0; n < 20000; ++n) {
        LayeredParams<float> p = random_layers(random, 0.05F);
        const Vec3f wo = direction_above(random, 0.05F);
        Vec3f wi = direction_above(random, 0.05F);
        if (n % 2 == 0) wi.z = -wi.z;
        // Where a facet is seen edge-on, rounding decides whether it refracts at all.
        if (p.solid && std::fabs(dot(wo, normalize(wo + wi * p.eta))) < 0.01F) continue;
        const auto value = [&](auto zero) {
            using F = decltype(zero);
            const LayeredParams<F> q = convert<F>(p);
            const Vec3<F> o = convert<F>(wo);
            return evaluate_layered(q, layered_weights(q, o), o, convert<F>(wi));
        };
        const BsdfValue<double> truth = value(0.0);
        const BsdfValue<float> one = value(0.0F);
        const BsdfValue<Lanes> many = value(Lanes(0.0F));
        const double bound = 2e-3 * max_component(truth.value_cos) + 1e-5;
        ASSERT_NEAR(one.value_cos.y, truth.value_cos.y, bound) << n;
        ASSERT_NEAR(lane(many.value_cos.y, lane_count - 1), truth.value_cos.y, bound) << n;
        ASSERT_NEAR(one.pdf, truth.pdf, 2e-3 * truth.pdf + 1e-5) << n;
        ASSERT_NEAR(lane(many.pdf, 0), truth.pdf, 2e-3 * truth.pdf + 1e-5) << n;
    }
}

TEST(Layers, StretchedHighlightsAreReciprocal) {
    Pcg32 random(6);
    for (int n = 0; n < 20000; ++n) {
        LayeredParams<double> p = convert<double>(random_layers(random, 0.02F));
        p.coat = p.transmission = 0;
        p.diffuse_transmission = 1;  // no diffuse reflection: its share is taken at wo
        p.thin_film.strength = 0;
        p.sheen_color = {0, 0, 0};
        p.solid = false;
        p.metallic = n % 2 == 0 ? 0 : 1;
        // The light of further bounces is counted at the viewer's direction.
        const auto gain = [&](const Vec3d& view) {
            const LayeredWeights<double> w = layered_weights(p, view);
            return n % 2 == 0 ? w.dielectric.x : w.metal.x;
        };
        const Vec3d wo = normalize(convert<double>(direction_above(random, 0.02F)));
        const Vec3d wi = normalize(convert<double>(direction_above(random, 0.02F)));
        const double there =
            evaluate_layered(p, layered_weights(p, wo), wo, wi).value_cos.x / wi.z / gain(wo);
        const double back =
            evaluate_layered(p, layered_weights(p, wi), wi, wo).value_cos.x / wo.z / gain(wi);
        ASSERT_NEAR(there, back, 1e-6 * back + 1e-12) << n;
    }
}

TEST(Layers, SmoothGlassFollowsSnell) {
    for (const float eta : {1.1F, 1.5F, 2.4F, 1 / 1.1F, 1 / 1.5F}) {
        for (float sine = 0; sine < 0.99F; sine += 0.07F) {
            const LayeredParams<float> p = clear_glass(min_ggx_alpha, eta);
            const Vec3f wo{sine, 0, std::sqrt(1 - sine * sine)};
            const Vec3f through = transmit(p, wo, Vec3f{0, 0, 1});
            if (sine > eta) {
                EXPECT_GE(through.z, 0) << "total reflection, eta " << eta;
                continue;
            }
            EXPECT_NEAR(through.x, -sine / eta, 1e-6F);
            EXPECT_NEAR(length(through), 1, 1e-6F);
            EXPECT_LT(through.z, 0);
        }
    }
}

TEST(ThinFilm, OfNoThicknessIsNoneAndOfSomeHasColours) {
    EXPECT_EQ(thin_film_presence(0.0F), 0.0F);
    EXPECT_EQ(thin_film_presence(100.0F), 1.0F);
    EXPECT_LT(thin_film_presence(1.0F), 0.01F);  // no jump
    const Vec3f some = thin_film_reflectance(1.0F, ThinFilm<float>{1, 1.8F, 300}, splat3(0.04F));
    EXPECT_GT(max_component(some) - std::min({some.x, some.y, some.z}), 0.05F);
}

}  // namespace
}  // namespace obscura
