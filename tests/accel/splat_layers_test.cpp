// tests/accel/splat_layers_test.cpp - splats along rays: all of them, sorted and blended.
// SPDX-License-Identifier: Apache-2.0
#include "accel/splat_layers.h"

#include "accel/accel_scenes.h"
#include "surface/srgb.h"

#include <gtest/gtest.h>

#include "support/splat_scenes.h"
#include <algorithm>

namespace obscura::test {
namespace {

struct Rays {
    std::vector<float> column[7];
    void add(const Vec3f& o, const Vec3f& d, float end = 3e38F) {
        const float numbers[7] = {o.x, o.y, o.z, d.x, d.y, d.z, end};
        for (size_t c = 0; c < 7; ++c)
            column[c].push_back(numbers[c]);
    }
    RayColumns columns() const {
        return {column[0].data(),
                column[1].data(),
                column[2].data(),
                column[3].data(),
                column[4].data(),
                column[5].data(),
                column[6].data(),
                nullptr,
                static_cast<int>(column[0].size())};
    }
    Vec3d origin(size_t i) const { return {column[0][i], column[1][i], column[2][i]}; }
    Vec3d direction(size_t i) const { return {column[3][i], column[4][i], column[5][i]}; }
};

struct Blended {
    std::vector<float> r, g, b, passes;
};

Blended blend(const Accel& accel, const Rays& rays, bool parallel = false) {
    const size_t n = rays.column[0].size();
    Blended out{
        std::vector<float>(n), std::vector<float>(n), std::vector<float>(n), std::vector<float>(n)};
    accel.blend_splats(
        rays.columns(), parallel, {out.r.data(), out.g.data(), out.b.data(), out.passes.data()});
    return out;
}

/// The over operator from near to far, all in double.
struct Over {
    double red = 0, passes = 1;
};

Over over(const std::vector<TestSplat>& splats, const Vec3d& o, const Vec3d& d, double end) {
    struct Layer {
        double t, alpha, red;
    };
    std::vector<Layer> layers;
    for (const TestSplat& splat : splats) {
        const TruePassage at = true_passage(splat.world_from_ball, o, d);
        const double alpha = true_alpha(static_cast<double>(splat.opacity), at.squared);
        if (at.t > 0 && at.t <= end)
            layers.push_back({at.t, alpha, static_cast<double>(splat.color.x)});
    }
    std::sort(
        layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.t < b.t; });
    Over out;
    for (const Layer& layer : layers) {
        out.red += out.passes * layer.alpha * layer.red;
        out.passes *= 1 - layer.alpha;
    }
    return out;
}

std::vector<TestSplat> cloud(int count, double sigma, float opacity, uint64_t seed) {
    Pcg32 random(seed);
    std::vector<TestSplat> out;
    for (int i = 0; i < count; ++i) {
        TestSplat splat;
        for (auto& row : splat.world_from_ball.m) {
            for (int c = 0; c < 3; ++c)
                row[c] = sigma * (2 * random.next_double() - 1);
            row[3] = 2 * random.next_double() - 1;
        }
        splat.opacity = opacity * random.next_float();
        splat.color = {random.next_float(), 0, 1};
        out.push_back(splat);
    }
    return out;
}

Rays rays_at_the_centre(int count, uint64_t seed) {
    Pcg32 random(seed);
    Rays rays;
    const auto number = [&] { return 2 * random.next_float() - 1; };
    for (int i = 0; i < count; ++i) {
        const Vec3f from = normalize(Vec3f{number(), number(), number()}) * 4.0F;
        const Vec3f to{number(), number(), number()};
        rays.add(from, normalize(to - from), i % 3 == 0 ? 3.5F : 3e38F);
    }
    return rays;
}

Scene scene_of(const std::vector<TestSplat>& splats, bool linear = true) {
    Scene scene = SceneBuilder().take();
    add_splats(scene, splats, linear);
    return scene;
}

/// Few, many and more than the first buffer holds; thin and dense.
TEST(SplatLayers, AreBlendedFromNearToFar) {
    struct Case {
        int count;
        double sigma;
        float opacity;
    };
    for (const Case& c :
         {Case{3, 0.5, 1}, Case{900, 0.1, 0.9F}, Case{3000, 0.4, 0.02F}, Case{3000, 0.3, 0.6F}}) {
        const std::vector<TestSplat> splats = cloud(c.count, c.sigma, c.opacity, 31);
        const BuiltScene built = build(scene_of(splats));
        const Rays rays = rays_at_the_centre(300, 32);
        const Blended got = blend(built.accel, rays);
        int crossed = 0;
        int exact = 0;
        for (size_t i = 0; i < got.r.size(); ++i) {
            const Over truth = over(
                splats, rays.origin(i), rays.direction(i), static_cast<double>(rays.column[6][i]));
            // A splat at its very end is there or not: 1 / 255 of the light at opacity 1/255.
            EXPECT_NEAR(static_cast<double>(got.passes[i]), truth.passes, 0.012) << c.count;
            EXPECT_NEAR(static_cast<double>(got.r[i]), truth.red, 0.012) << c.count;
            exact += std::abs(static_cast<double>(got.r[i]) - truth.red) < 2e-4 ? 1 : 0;
            EXPECT_EQ(got.g[i], 0);
            EXPECT_NEAR(got.b[i], 1 - got.passes[i], 2e-4F);
            crossed += truth.passes < 0.9 ? 1 : 0;
        }
        EXPECT_GT(crossed, 20) << c.count;
        EXPECT_GT(exact, 285) << c.count;
    }
}

TEST(SplatLayers, InTheOppositeOrderFromBehind) {
    const std::vector<TestSplat> splats = {{ball({0, 0, 1}, 1), 0.5F, {1, 0, 0}},
                                           {ball({0, 0, 0}, 1), 0.75F, {0, 1, 0}},
                                           {ball({0, 0, -1}, 1), 1, {0, 0, 1}}};
    const BuiltScene built = build(scene_of(splats));
    Rays rays;
    rays.add({0, 0, 9}, {0, 0, -1});
    rays.add({0, 0, -9}, {0, 0, 1});
    rays.add({0, 0, 9}, {0, 0, -1}, 9.5F);
    rays.add({0, 0, 0.5F}, {0, 0, 1});
    const Blended got = blend(built.accel, rays);
    const float expected[4][4] = {
        {0.5F, 0.375F, 0.125F, 0}, {0, 0, 1, 0}, {0.5F, 0.375F, 0, 0.125F}, {0.5F, 0, 0, 0.5F}};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(got.r[i], expected[i][0], 1e-6F) << i;
        EXPECT_NEAR(got.g[i], expected[i][1], 1e-6F) << i;
        EXPECT_NEAR(got.b[i], expected[i][2], 1e-6F) << i;
        EXPECT_NEAR(got.passes[i], expected[i][3], 1e-6F) << i;
    }
}

/// Codes of the display are mixed, and then decoded: one half red over full red.
TEST(SplatLayers, EncodedColoursAreMixedAsTheyAre) {
    const std::vector<TestSplat> splats = {{ball({0, 0, 1}, 1), 0.5F, {0.2F, 0, 0}},
                                           {ball({0, 0, 0}, 1), 0.5F, {0.8F, 0, 0}}};
    const BuiltScene built = build(scene_of(splats, false));
    Rays rays;
    rays.add({0, 0, 9}, {0, 0, -1});
    const Blended got = blend(built.accel, rays);
    const double code = (0.2 * 0.5 + 0.8 * 0.25) / 0.75;
    EXPECT_NEAR(got.r[0], 0.75 * std::pow((code + 0.055) / 1.055, 2.4), 1e-5);
    EXPECT_NEAR(got.passes[0], 0.25, 1e-6);
}

/// The harmonic (1, 0) grows along z: a splat is brighter along directions closer to +z.
TEST(SplatLayers, HarmonicsFollowTheDirectionToTheCentre) {
    TestSplat splat{ball({0, 0, 0}, 1), 1, {0.5F, 0.5F, 0.5F}};
    splat.harmonics = {0, 0, 0, 0.4F, 0, 0, 0, 0, 0};
    const BuiltScene built = build(scene_of({splat}));
    Rays rays;
    const Vec3f eye{3, 0, 4};
    const Vec3f beside = normalize(Vec3f{0.2F, 0.1F, 0} - eye);
    rays.add(eye, beside);
    const double slope = 0.4 * std::sqrt(3 / (4 * pi_d));
    for (const bool parallel : {false, true}) {
        const Blended got = blend(built.accel, rays, parallel);
        const double z = parallel ? static_cast<double>(beside.z) : -0.8;
        EXPECT_NEAR(got.r[0] / (1 - got.passes[0]), 0.5 + slope * z, 1e-4);
        EXPECT_NEAR(got.g[0] / (1 - got.passes[0]), 0.5, 1e-4);
    }
}

TEST(SplatLayers, ShadowRaysAreDimmedByAllInTheirWay) {
    const std::vector<TestSplat> splats = cloud(500, 0.2, 0.7F, 41);
    const BuiltScene built = build(scene_of(splats));
    const Rays rays = rays_at_the_centre(200, 42);
    const Blended seen = blend(built.accel, rays);
    std::vector<float> passes(200, -1.0F);
    std::vector<uint8_t> skips(200, 0);
    skips[7] = 1;
    built.accel.dim_by_splats(rays.columns(), skips.data(), passes.data());
    for (size_t i = 0; i < passes.size(); ++i)
        EXPECT_EQ(passes[i], i == 7 ? 1 : seen.passes[i]);
}

TEST(SplatLayers, AreNothingThatOtherQueriesHit) {
    const BuiltScene built = build(scene_of({{ball({0, 0, 0}, 1)}}));
    EXPECT_TRUE(built.accel.has_splats());
    EXPECT_FALSE(build(SceneBuilder().take()).accel.has_splats());
    RayList rays;
    rays.add({0, 0, 9}, {0, 0, -1});
    rays.intersect(built.accel, Coherence::coherent);
    EXPECT_FALSE(rays.hit(0));
}

TEST(SplatLayers, RaysThatAreNotFinitePassNone) {
    const BuiltScene built = build(scene_of({{ball({0, 0, 0}, 1)}}));
    Rays rays;
    rays.add({0, 0, 9}, {0, 0, std::nanf("")});
    rays.add({std::nanf(""), 0, 9}, {0, 0, -1});
    const Blended got = blend(built.accel, rays);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(got.passes[i], 1);
}

TEST(SplatLayers, InstructionSetsAgree) {
    const std::vector<TestSplat> splats = cloud(2000, 0.2, 0.8F, 51);
    const Rays rays = rays_at_the_centre(200, 52);
    const BuiltScene first = build(scene_of(splats), "sse4.2");
    const Blended expected = blend(first.accel, rays);
    for (const Isa isa : all_isas()) {
        const BuiltScene other = build(scene_of(splats), embree_isa_for(isa));
        const Blended got = blend(other.accel, rays);
        for (size_t i = 0; i < got.r.size(); ++i) {
            EXPECT_NEAR(got.r[i], expected.r[i], 0.012F);
            EXPECT_NEAR(got.passes[i], expected.passes[i], 0.012F);
        }
    }
}

}  // namespace
}  // namespace obscura::test
