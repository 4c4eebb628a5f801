// tests/truth/scattering_test.cpp - subsurface scattering against random walks in double precision.
// SPDX-License-Identifier: Apache-2.0
#include "surface/scattering.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "truth/dielectric_scene.h"

namespace obscura::test {
namespace scattering_truth {

/// A medium without refraction, so that a random walk begins and ends where its surface is.
MaterialLayers cloud(const Vec3f& extinction, const Vec3f& albedo, float anisotropy) {
    MaterialLayers layers = dielectric(1.0f, extinction);
    layers.scatter_albedo[0] = albedo.x;
    layers.scatter_albedo[1] = albedo.y;
    layers.scatter_albedo[2] = albedo.z;
    layers.scatter_anisotropy = anisotropy;
    return layers;
}

std::array<Mean, 3> seen_sphere(const MaterialLayers& layers) {
    DielectricScene scene;
    const int32_t index = scene.add(layers);
    scene.builder.sphere({0, 0, 0}, 1, 96, index);
    return means_from_front(scene.take(), {.samples = 1024});
}

/// Four standard errors, and what the boundary's least bend (1.001) costs: its facets, a little
/// rough for the sake of single precision, lose some of the light that meets them at grazing
/// angles.
void expect_mean(const Mean& seen, double expected) {
    EXPECT_NEAR(seen.value, expected, 4 * seen.error + 0.005);
    EXPECT_LT(seen.error, 0.005);
}

/// Where a ray from inside the unit sphere leaves it.
double distance_to_boundary(const Vec3d& p, const Vec3d& d) {
    const double b = dot(p, d);
    return -b + std::sqrt(std::max(0.0, b * b - dot(p, p) + 1));
}

double uniform(Pcg32& random) {
    return (random.next_uint() + 0.5) * 0x1p-32;
}

/// A new direction by the phase function's definition: candidates are kept by its value.
Vec3d turned(const Vec3d& d, double g, Pcg32& random) {
    const double most = (1 - g * g) / std::pow(1 - std::abs(g), 3);
    for (;;) {
        const double z = 1 - 2 * uniform(random);
        const double phi = 2 * pi_d * uniform(random);
        const double r = std::sqrt(1 - z * z);
        const Vec3d to{r * std::cos(phi), r * std::sin(phi), z};
        const double value = (1 - g * g) / std::pow(1 + g * g - 2 * g * dot(d, to), 1.5);
        if (uniform(random) * most < value) return to;
    }
}

/// Fraction of the random walks along the unit sphere's axis that are not absorbed: its radiance
/// under a white sky.
double escaping(double extinction, double albedo, double g) {
    constexpr int walks = 200000;
    Pcg32 random(7);
    int out = 0;
    for (int n = 0; n < walks; ++n) {
        Vec3d p{0, 0, 1};
        Vec3d d{0, 0, -1};
        for (;;) {
            const double flight = -std::log(uniform(random)) / extinction;
            if (flight >= distance_to_boundary(p, d)) {
                ++out;
                break;
            }
            if (uniform(random) >= albedo) break;
            p = p + d * flight;
            d = turned(d, g, random);
        }
    }
    return static_cast<double>(out) / walks;
}

TEST(Scattering, WhatAbsorbsNothingVanishesUnderAWhiteSky) {
    for (const float anisotropy : {-0.5f, 0.0f, 0.9f}) {
        SCOPED_TRACE(anisotropy);
        const std::array<Mean, 3> seen =
            seen_sphere(cloud({0.5f, 4.0f, 20.0f}, {1, 1, 1}, anisotropy));
        expect_mean(seen[0], 1);
        expect_mean(seen[1], 1);
        expect_mean(seen[2], 1);
    }
}

TEST(Scattering, SpheresShowWhatRandomWalksInDoublePrecisionFind) {
    const Vec3f extinction{0.5f, 2.0f, 8.0f};
    const Vec3f albedo{0.9f, 0.7f, 0.95f};
    for (const float g : {-0.6f, 0.0f, 0.8f}) {
        SCOPED_TRACE(g);
        const std::array<Mean, 3> seen = seen_sphere(cloud(extinction, albedo, g));
        const auto mean_cosine = static_cast<double>(g);
        expect_mean(seen[0], escaping(0.5, 0.9, mean_cosine));
        expect_mean(seen[1], escaping(2, 0.7, mean_cosine));
        expect_mean(seen[2], escaping(8, 0.95, mean_cosine));
    }
}

/// A channel that scatters does not change what another one only absorbs.
TEST(Scattering, ChannelsDoNotMix) {
    const std::array<Mean, 3> seen =
        seen_sphere(cloud({0.5f, 3.0f, 0.0f}, {0.0f, 0.8f, 0.0f}, 0.0f));
    expect_mean(seen[0], std::exp(-1.0));
    expect_mean(seen[2], 1);
}

/// With a smooth surface, light reflected inside continues its random walk.
TEST(Scattering, GlassAroundLosesNothing) {
    MaterialLayers milk = cloud({3.0f, 3.0f, 3.0f}, {1, 1, 1}, 0.0f);
    milk.ior = 1.5f;
    expect_mean(seen_sphere(milk)[0], 1);
}

/// Light that enters and leaves diffusely, as in skin and wax, meets the boundary on its way out.
TEST(Scattering, DiffuseSolidsLoseAndGainNothing) {
    for (const float share : {0.5f, 1.0f}) {
        SCOPED_TRACE(share);
        MaterialLayers wax = cloud({3.0f, 3.0f, 3.0f}, {1, 1, 1}, 0.0f);
        wax.ior = 1.5f;
        wax.transmission = 0;
        wax.diffuse_transmission = share;
        expect_mean(seen_sphere(wax)[0], 1);
    }
}

}  // namespace scattering_truth
}  // namespace obscura::test
