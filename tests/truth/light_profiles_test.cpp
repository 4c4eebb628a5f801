// tests/truth/light_profiles_test.cpp - IES lamps against illuminances worked out by hand.
// SPDX-License-Identifier: Apache-2.0
#include "camera/camera_models.h"
#include "render/light_table.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace light_profiles_truth {

constexpr int side = 24;
constexpr double height = 2.0;

/// 900 cd downwards, 300 cd at 40 degrees, nothing at 80; more towards +X than towards -X.
LightProfile lamp_profile() {
    LightProfile profile;
    profile.polar_deg = {0, 40, 80};
    profile.azimuth_deg = {0, 180, 360};
    profile.candela = {900, 300, 0, 900, 100, 0, 900, 300, 0};
    return profile;
}

double candela(double polar_deg, double azimuth_deg) {
    const double at_40 = 300 - 200 * std::fabs(azimuth_deg) / 180;
    if (polar_deg > 80) return 0;
    return polar_deg < 40 ? 900 + (at_40 - 900) * polar_deg / 40 : at_40 * (80 - polar_deg) / 40;
}

/// A floor under the lamp, and a lamp without a profile that is far too weak to be seen.
Scene lamp_scene(const Material& ground) {
    SceneBuilder builder;
    builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(ground));
    Scene scene = builder.take();
    PunctualLight lamp;
    lamp.profile = 0;
    lamp.position[1] = static_cast<float>(height);
    lamp.direction[1] = -1;
    lamp.direction[2] = 0;
    scene.light_profiles = {lamp_profile()};
    PunctualLight faint;
    std::fill_n(faint.intensity, 3, 1e-9f);
    faint.position[1] = 1;
    scene.lights = {faint, lamp};
    return scene;
}

Material ground_material() {
    Material m;
    std::fill_n(m.base_color, 3, 0.5f);
    m.metallic = 0;
    m.roughness = 1;
    return m;
}

/// Radiance of the floor where a pixel looks at it, seen from straight above: f E, with E = I cos^3
/// / h^2.
double expected_at(const Camera& camera, double x, double y) {
    const CameraRay<double> ray = generate_ray<double>(camera, Vec2<double>{x / side, y / side});
    const Vec3d at = ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
    const double across = std::hypot(at.x, at.z);
    const double polar = std::atan2(across, height);
    const double azimuth = std::atan2(at.z, at.x);
    const double cosine = std::cos(polar);
    const double illuminance = candela(polar * 180 / pi_d, azimuth * 180 / pi_d) * cosine * cosine *
                               cosine / (height * height);
    // In the floor's frame the normal is z: (x, y, z) of the world becomes (z, x, y).
    const Vec3d to_light = normalize(Vec3d{-at.z, -at.x, height});
    const Vec3d to_eye = normalize(Vec3d{-ray.direction.z, -ray.direction.x, -ray.direction.y});
    return evaluate_bsdf(exact_bsdf(ground_material()), to_eye, to_light).value_cos.x / to_light.z *
           illuminance;
}

TEST(LightProfiles, RaycastMeetsTheIlluminanceInEveryPixel) {
    const Camera camera = look_at({0.01f, 300, 0}, {0.01f, 0, 0}, 0.016f, side, side);
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.integrator = Integrator::raycast;
    const Film film = render_scene(lamp_scene(ground_material()), {}, camera, options).film;
    double brightest = 0;
    for (int i = 0; i < side * side; ++i) {
        const int row = i / side;
        const double expected = expected_at(camera, i % side + 0.5, row + 0.5);
        ASSERT_NEAR(film.pixels[4 * static_cast<size_t>(i)], expected, 2e-4 * expected + 1e-6)
            << i % side << " " << row;
        brightest = std::max(brightest, expected);
    }
    EXPECT_GT(brightest, 20);
}

/// Without bounces the path tracer sees the lamp alone; the faint one takes some of the samples.
TEST(LightProfiles, ThePathTracerConvergesToTheSame) {
    for (const Vec3f& at : {Vec3f{0.7f, 0, 0.4f}, Vec3f{-0.9f, 0, -1.1f}}) {
        const Camera camera = look_at({at.x, 300, at.z}, at, 1e-5f, side, side);
        RenderOptions options;
        options.width = side;
        options.height = side;
        options.samples_per_pixel = 64;
        options.integrator = Integrator::direct;
        const Mean mean =
            film_mean(render_scene(lamp_scene(ground_material()), {}, camera, options).film);
        const double expected = expected_at(camera, 0.5 * side, 0.5 * side);
        EXPECT_NEAR(mean.value / expected, 1, 2e-3);
        EXPECT_LT(mean.error / expected, 1e-3) << "the lamp's power counts where lights are chosen";
    }
}

/// A lamp is chosen by its total light, not by its strongest direction.
TEST(LightProfiles, PowerDecidesHowOftenALampIsChosen) {
    Scene scene = lamp_scene(ground_material());
    std::fill_n(scene.lights[0].intensity, 3, 50.0f);
    const LightTable table = make_light_table(scene, nullptr);
    const double lumens = profile_lumens(lamp_profile());
    EXPECT_NEAR(table.select_pdf[1], lumens / (lumens + 4 * pi_d * 50), 1e-6);
}

}  // namespace light_profiles_truth
}  // namespace obscura::test
