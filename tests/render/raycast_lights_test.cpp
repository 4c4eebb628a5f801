// tests/render/raycast_lights_test.cpp - lamps and environments in ray casting.
// SPDX-License-Identifier: Apache-2.0
#include "render/raycast_lights.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::test {
namespace {

/// A smooth map with all terms up to the second order, turned about +Y.
EnvironmentTable smooth_sky(double rotation_deg) {
    const int width = 256;
    const int height = 128;
    std::vector<float> rgb;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const double theta = pi_d * (row + 0.5) / height;
            const double phi = 2 * pi_d * ((column + 0.5) / width - 0.5);
            const double x = std::sin(theta) * std::cos(phi);
            const double y = std::cos(theta);
            const double z = std::sin(theta) * std::sin(phi);
            rgb.push_back(static_cast<float>(3 + x - 0.5 * y + 0.3 * z));
            rgb.push_back(static_cast<float>(2 + 0.8 * x * y - 0.6 * y * z + 0.7 * z * x));
            rgb.push_back(static_cast<float>(2 + 0.5 * (3 * z * z - 1) - 0.4 * (x * x - y * y)));
        }
    }
    return EnvironmentTable::create({width, height, rgb.data()}, 1, rotation_deg).value();
}

/// Integral of radiance times cosine over the hemisphere around n.
Vec3d irradiance(const EnvironmentView& sky, const Vec3d& n) {
    const Frame<double> frame = frame_around(n);
    constexpr int side = 128;
    Vec3d sum = splat3(0.0);
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const Vec3d local = cosine_hemisphere(Vec2<double>{(i + 0.5) / side, (j + 0.5) / side});
            sum = sum + environment_radiance<double>(sky, to_world(frame, local));
        }
    }
    return sum * (pi_d / (side * side));
}

TEST(RaycastLights, IrradianceOfSmoothSkiesIsExact) {
    for (const double rotation : {0.0, 40.0, -100.0}) {
        const EnvironmentTable sky = smooth_sky(rotation);
        const AmbientLight light = project_environment(sky.view());
        for (const Vec3d& direction :
             {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}, Vec3d{0.3, -0.8, 0.5}}) {
            const Vec3d n = normalize(direction);
            const Vec3d got = ambient_irradiance<double>(light, n);
            const Vec3d expected = irradiance(sky.view(), n);
            EXPECT_NEAR(got.x, expected.x, 2e-3 * expected.x) << rotation << " " << n.x;
            EXPECT_NEAR(got.y, expected.y, 2e-3 * expected.y) << rotation << " " << n.x;
            EXPECT_NEAR(got.z, expected.z, 2e-3 * expected.z) << rotation << " " << n.x;
        }
    }
}

TEST(RaycastLights, LampsAreNeverBrighterThanTheirSurface) {
    // The irradiance of a flat lamp of radiance L is at most pi L, as at the lamp's centre.
    CentreLight light;
    std::fill_n(light.intensity, 3, 10.0f * 4.0f);
    light.flat = 1;
    light.min_distance_squared = static_cast<float>(4.0 / pi_d);
    const auto near = sample_centre_light<double>(&light, 0, Vec3d{0, 1e-4, 0});
    EXPECT_NEAR(near.irradiance.x, 10 * pi_d, 1e-4);
    const auto far = sample_centre_light<double>(&light, 0, Vec3d{0, 20, 0});
    EXPECT_NEAR(far.irradiance.x, 40.0 / 400, 1e-9);
    EXPECT_EQ(sample_centre_light<double>(&light, 0, Vec3d{0, -1, 0}).irradiance.x, 0);
    light.two_sided = 1;
    EXPECT_GT(sample_centre_light<double>(&light, 0, Vec3d{0, -1, 0}).irradiance.x, 0);
}

TEST(RaycastLights, AHeadlightOnlyWhereThereIsNoOtherLight) {
    const auto lights_of = [](float emission, bool bulb, std::shared_ptr<const ImageRgb32f> sky) {
        SceneBuilder builder;
        Material m;
        std::fill_n(m.emission, 3, emission);
        if (!(emission > 0)) m.flags = material_unlit;  // no studio
        builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.material(m));
        Scene scene = builder.take();
        if (bulb) scene.lights.emplace_back();
        LightingOptions lighting;
        lighting.environment = std::move(sky);
        Log log(Verbosity::quiet);
        auto prepared =
            PreparedScene::create(std::move(scene), std::move(lighting), Isa::automatic, log);
        return make_raycast_lights(prepared.value().impl());
    };
    EXPECT_TRUE(lights_of(0, false, {}).headlight);
    EXPECT_FALSE(lights_of(0, true, {}).headlight);
    EXPECT_FALSE(lights_of(5, false, {}).headlight);
    EXPECT_EQ(lights_of(5, false, {}).centres.size(), 1U);
    EXPECT_FALSE(lights_of(0, false, constant_environment(1)).headlight);
    EXPECT_TRUE(lights_of(0, false, constant_environment(1)).ambient);
    // A black sky that was asked for gives a black image.
    EXPECT_FALSE(lights_of(0, false, constant_environment(0)).headlight);
}

}  // namespace
}  // namespace obscura::test
