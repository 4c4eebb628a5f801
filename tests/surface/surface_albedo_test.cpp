// tests/surface/surface_albedo_test.cpp - albedos against quadrature, sampling and random walks.
// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_albedo.h"

#include <gtest/gtest.h>

#include "support/bsdf_albedo.h"
#include "support/layered_materials.h"
#include <string>

namespace obscura {
namespace {

using namespace test;

constexpr Vec3d along_normal{0, 0, 1};

TEST(SurfaceAlbedo, OfTheCoreMaterialIsItsIntegral) {
    for (const double metallic : {0.0, 0.4, 1.0}) {
        for (const double roughness : {0.1, 0.5, 1.0}) {
            const BsdfParams<double> p = bsdf_of({0.9, 0.3, 0.05}, metallic, roughness);
            const SurfaceAlbedo<double> got = surface_albedo(p);
            const Vec3d expected = quadrature_albedo(p, along_normal).albedo;
            const auto where = std::to_string(metallic) + ", " + std::to_string(roughness);
            EXPECT_NEAR(got.all.x, expected.x, 4e-3) << where;
            EXPECT_NEAR(got.all.y, expected.y, 4e-3) << where;
            EXPECT_NEAR(got.all.z, expected.z, 4e-3) << where;
            EXPECT_NEAR(got.spread, max_component(got.all), 1e-9) << "all of it is rough";
        }
    }
}

/// The radiance towards the normal under a white sky, by sampling.
Vec3d sampled_albedo(const LayeredParams<float>& p, int samples) {
    Pcg32 random(3);
    const Vec3f wo{0, 0, 1};
    const LayeredWeights<float> weights = layered_weights(p, wo);
    Vec3d sum{0, 0, 0};
    for (int i = 0; i < samples; ++i) {
        const auto sample = sample_layered(p, weights, wo, random_point(random));
        if (!(sample.at.pdf > 0)) continue;
        const Vec3f w = sample.at.value_cos * (1.0F / sample.at.pdf);
        sum = sum + Vec3d{w.x, w.y, w.z};
    }
    return sum * (1.0 / samples);
}

SurfaceAlbedo<float> layered_albedo(const LayeredParams<float>& p) {
    const Vec3f white{1, 1, 1};
    return surface_albedo(p, white);
}

TEST(SurfaceAlbedo, OfLayersIsWhatSamplingFinds) {
    Pcg32 random(8);
    constexpr int cases = 200;
    double error = 0;
    for (int n = 0; n < cases; ++n) {
        LayeredParams<float> p = random_layers(random, 0.01F);
        p.coat_normal = {0, 0, 1};
        const Vec3f got = layered_albedo(p).all;
        const Vec3d expected = sampled_albedo(p, 4000);
        EXPECT_LE(max_component(got), 1) << n;
        const double wrong[] = {static_cast<double>(got.x) - std::min(expected.x, 1.0),
                                static_cast<double>(got.y) - std::min(expected.y, 1.0),
                                static_cast<double>(got.z) - std::min(expected.z, 1.0)};
        for (const double w : wrong) {
            EXPECT_LT(std::abs(w), 0.2) << n;
            error += std::abs(w) / (3 * cases);
        }
    }
    EXPECT_LT(error, 0.02);
}

TEST(SurfaceAlbedo, MirrorsAndClearGlassSpreadNothing) {
    LayeredParams<float> metal = plain_layers(min_ggx_alpha);
    metal.metallic = 1;
    LayeredParams<float> coated = metal;
    coated.coat = 1;
    coated.coat_alpha = min_ggx_alpha;
    LayeredParams<float> thin_air = clear_glass(0.04F, 1.001F);  // widened, invisibly
    for (const LayeredParams<float>& clear : {metal,
                                              coated,
                                              thin_air,
                                              clear_glass(min_ggx_alpha, 1.5F),
                                              clear_glass(min_ggx_alpha, 1 / 1.5F),
                                              clear_glass(min_ggx_alpha, 0)}) {
        EXPECT_LT(layered_albedo(clear).spread, min_spread);
    }
    LayeredParams<float> brushed = metal;
    brushed.alpha.x = 0.1F;
    LayeredParams<float> dull_coat = coated;
    dull_coat.coat_alpha = 0.1F;
    LayeredParams<float> painted = clear_glass(min_ggx_alpha, 0);
    painted.transmission = 0.9F;
    LayeredParams<float> cloth = metal;
    cloth.sheen_color = {0.5F, 0.5F, 0.5F};
    for (const LayeredParams<float>& rough : {plain_layers(min_ggx_alpha),
                                              brushed,
                                              dull_coat,
                                              painted,
                                              cloth,
                                              clear_glass(0.04F, 1.5F)}) {
        EXPECT_GT(layered_albedo(rough).spread, min_spread);
    }
    const float least = min_ggx_alpha;
    EXPECT_LT(surface_albedo(BsdfParams<float>{{0.9F, 0.8F, 0.1F}, 1, least}).spread, min_spread);
    EXPECT_LT(surface_albedo(BsdfParams<float>{{0, 0, 0}, 0, least}).spread, min_spread);
    EXPECT_GT(surface_albedo(BsdfParams<float>{{0, 0, 0}, 0, 0.1F}).spread, min_spread);
}

/// Share of diffuse light that comes back from a half space of isotropic scatterers.
double walked_reflectance(double albedo) {
    Pcg32 random(1);
    constexpr int walks = 40000;
    double sum = 0;
    for (int n = 0; n < walks; ++n) {
        double depth = 0;
        double cosine = std::sqrt(random.next_double());  // into the medium, as from all sides
        for (double left = 1; left > 1e-4;) {
            depth += -std::log(1 - random.next_double()) * cosine;
            if (depth < 0) {
                sum += left;
                break;
            }
            left *= albedo;
            cosine = 2 * random.next_double() - 1;
        }
    }
    return sum / walks;
}

TEST(SurfaceAlbedo, OfADeepMediumIsWhatRandomWalksBringBack) {
    for (const double albedo : {0.0, 0.3, 0.7, 0.95, 0.99}) {
        EXPECT_NEAR(medium_reflectance(albedo, 0.0), walked_reflectance(albedo), 0.01) << albedo;
    }
    EXPECT_NEAR(medium_reflectance(1.0, 0.5), 1, 1e-12);
    EXPECT_LT(medium_reflectance(0.9, 0.8), medium_reflectance(0.9, 0.0)) << "light goes deeper";
}

}  // namespace
}  // namespace obscura
