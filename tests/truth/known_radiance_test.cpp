// tests/truth/known_radiance_test.cpp - scenes whose radiance is known, within half a percent.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace known_radiance_truth {

constexpr int image_size = 32;
#ifdef OBSCURA_DEBUG
constexpr int samples = 64;
constexpr double tolerance = 0.02;  // a sixteenth of the samples: four times the noise
#else
constexpr int samples = 1024;
constexpr double tolerance = 0.005;
#endif

RenderOptions small_image() {
    RenderOptions options;
    options.width = image_size;
    options.height = image_size;
    options.samples_per_pixel = samples;
    return options;
}

/// Half a percent, even for noisier estimators: three standard errors must fit in.
void expect_close(const Mean& mean, double expected) {
    ASSERT_LE(3.0 * mean.error, tolerance * expected) << "too few samples to tell";
    EXPECT_NEAR(mean.value, expected, tolerance * expected);
}

Material white(float metallic, float roughness) {
    Material m;
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

/// A camera that sees a floor patch under `angle` from its normal, all pixels nearly alike.
Camera slanted_camera(float angle) {
    const Vec3f eye{0, 1000 * std::cos(angle), 1000 * std::sin(angle)};
    return look_at(eye, {0, 0, 0}, 4e-5f, image_size, image_size);
}

Scene floor_scene(const Material& m) {
    SceneBuilder builder;
    const int32_t index = builder.material(m);
    builder.quad({-100, 0, 100}, {200, 0, 0}, {0, 0, -200}, index);
    return builder.take();
}

struct FurnaceCase {
    float metallic, roughness, angle;
};

class WhiteFurnace : public testing::TestWithParam<FurnaceCase> {};

TEST_P(WhiteFurnace, ReflectsTheAlbedoOfItsBrdf) {
    const auto [metallic, roughness, angle] = GetParam();
    const Material m = white(metallic, roughness);
    LightingOptions lighting;
    lighting.environment = constant_environment(1.0f);
    const Mean mean = film_mean(
        render_scene(floor_scene(m), lighting, slanted_camera(angle), small_image()).film);
    const Vec3d wo = polar_direction(std::cos(static_cast<double>(angle)), 0.0);
    const double albedo = reflected(exact_bsdf(m), wo, [](const Vec3d&) { return 1.0; });
    expect_close(mean, albedo);
    EXPECT_LE(mean.value, 1.0 + 3.0 * mean.error);
    EXPECT_GT(mean.value, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Roughnesses,
                         WhiteFurnace,
                         testing::Values(FurnaceCase{0, 0, 0.2f},
                                         FurnaceCase{0, 0.25f, 0.8f},
                                         FurnaceCase{0, 0.5f, 1.2f},
                                         FurnaceCase{0, 1, 0.5f},
                                         FurnaceCase{0.5f, 0.3f, 0.5f},
                                         FurnaceCase{0.5f, 0.9f, 1.3f},
                                         FurnaceCase{1, 0, 0.7f},
                                         FurnaceCase{1, 0.2f, 1.3f},
                                         FurnaceCase{1, 0.5f, 0.3f},
                                         FurnaceCase{1, 0.75f, 0.9f},
                                         FurnaceCase{1, 1, 0.6f}));

TEST(WhiteFurnace, SmoothMirrorLosesNothing) {
    LightingOptions lighting;
    lighting.environment = constant_environment(1.0f);
    const Mean mean = film_mean(
        render_scene(floor_scene(white(1, 0)), lighting, slanted_camera(0.5f), small_image()).film);
    EXPECT_NEAR(mean.value, 1.0, 0.005);
}

TEST(DirectionalLight, OnAPlaneIsBrdfTimesCosineTimesLux) {
    for (const float roughness : {0.3f, 0.7f}) {
        Material m = white(0, roughness);
        m.base_color[0] = 0.6f;
        Scene scene = floor_scene(m);
        PunctualLight sun;
        sun.type = static_cast<int32_t>(PunctualType::directional);
        const Vec3f direction = normalize(Vec3f{0.3f, -1.0f, 0.4f});
        std::copy_n(&direction.x, 3, sun.direction);
        std::fill_n(sun.intensity, 3, 5.0f);
        scene.lights.push_back(sun);
        const Mean mean =
            film_mean(render_scene(scene, {}, slanted_camera(0.4f), small_image()).film);
        // The floor's normal is +Y: local frame (z, x, y).
        const auto local = [](const Vec3d& v) { return Vec3d{v.z, v.x, v.y}; };
        const Vec3d wo = local({0, std::cos(0.4f), std::sin(0.4f)});
        const Vec3d wi = local(normalize(Vec3d{-0.3, 1.0, -0.4}));
        expect_close(mean, 5.0 * evaluate_bsdf(exact_bsdf(m), wo, wi).value_cos.x);
    }
}

TEST(PointLight, FallsOffWithTheSquareOfDistanceAndStopsAtItsRange) {
    Scene scene = floor_scene(white(0, 1));
    PunctualLight lamp;
    lamp.position[1] = 2.0f;
    std::fill_n(lamp.intensity, 3, 8.0f);
    lamp.range = 4.0f;
    scene.lights.push_back(lamp);
    const Mean mean = film_mean(render_scene(scene, {}, slanted_camera(0.3f), small_image()).film);
    const Vec3d wo = polar_direction(std::cos(static_cast<double>(0.3f)), 0.0);
    const double window = 1.0 - std::pow(2.0 / 4.0, 4);
    const double f = evaluate_bsdf(exact_bsdf(white(0, 1)), wo, {0, 0, 1}).value_cos.x;
    expect_close(mean, f * 8.0 / 4.0 * window);
}

TEST(EmissiveQuad, OnAFloorIsTheIntegralOverItsArea) {
    SceneBuilder builder;
    Material ground = white(0, 0.4f);
    ground.base_color[0] = 0.7f;
    Material lamp;
    std::fill_n(lamp.emission, 3, 12.0f);
    std::fill_n(lamp.base_color, 3, 0.0f);
    builder.quad({-100, 0, 100}, {200, 0, 0}, {0, 0, -200}, builder.material(ground));
    builder.quad({-0.5f, 1.5f, -1.0f}, {1, 0, 0}, {0, 0.3f, 0.8f}, builder.material(lamp));
    RenderOptions options = small_image();
    options.integrator = Integrator::direct;
    const Mean mean =
        film_mean(render_scene(builder.take(), {}, slanted_camera(0.5f), options).film);

    const BsdfParams<double> p = exact_bsdf(ground);
    const auto local = [](const Vec3d& v) { return Vec3d{v.z, v.x, v.y}; };
    const double angle = static_cast<double>(0.5f);
    const Vec3d wo = local({0, std::cos(angle), std::sin(angle)});
    const Vec3d a{1, 0, 0};
    const Vec3d b{0, 0.3, 0.8};
    const Vec3d normal = cross(a, b);  // its length is the area
    double expected = 0;
    constexpr int n = 400;
    for (int i = 0; i < n * n; ++i) {
        const Vec3d at = Vec3d{-0.5, 1.5, -1.0} + a * ((i % n + 0.5) / n) + b * ((i / n + 0.5) / n);
        const Vec3d wi = normalize(at);
        const double facing = std::max(0.0, -dot(normal, wi)) / dot(at, at);
        expected += evaluate_bsdf(p, wo, local(wi)).value_cos.x * facing;
    }
    expect_close(mean, 12.0 * expected / (n * n));
}

/// Radiance inside a closed sphere depends on the angle to the normal only, and a chord meets both
/// ends under the same angle: L(t) = source(t) + integral of f(t, t') L(t') cos t' over directions.
std::vector<double> solve_sphere(const BsdfParams<double>& p,
                                 const std::function<double(double)>& source) {
    constexpr int n = 64;
    constexpr int n_phi = 64;
    const auto cosine = [](int i) { return (i + 0.5) / n; };
    std::vector<std::vector<double>> kernel(n, std::vector<double>(n));
    for (int o = 0; o < n; ++o) {
        for (int i = 0; i < n; ++i) {
            for (int k = 0; k < n_phi; ++k) {
                const double phi = 2 * pi_d * (k + 0.5) / n_phi;
                const Vec3d wo = polar_direction(cosine(o), 0);
                kernel[o][i] += evaluate_bsdf(p, wo, polar_direction(cosine(i), phi)).value_cos.x *
                                2 * pi_d / n_phi / n;
            }
        }
    }
    std::vector<double> radiance(n, 0.0);
    for (int pass = 0; pass < 300; ++pass) {
        std::vector<double> next(n);
        for (int o = 0; o < n; ++o) {
            next[o] = source(cosine(o));
            for (int i = 0; i < n; ++i)
                next[o] += kernel[o][i] * radiance[i];
        }
        radiance = next;
    }
    return radiance;
}

/// Renders the inside of a closed sphere from near its wall, looking at a wall point under a known
/// angle, and compares with the integral equation.
void check_closed_sphere(const Material& m, bool lamp_inside) {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0f, 96, builder.material(m), true);
    Scene scene = builder.take();
    const double intensity = 2.0;
    if (lamp_inside) {
        PunctualLight lamp;
        std::fill_n(lamp.intensity, 3, static_cast<float>(intensity));
        scene.lights.push_back(lamp);
    }
    RenderOptions options = small_image();
    options.max_bounces = 60;
    // From the centre-plane towards +Z under 40 degrees to the wall's normal there.
    const double angle = 40.0 * pi_d / 180.0;
    const Vec3f wall{0, 0, 1};
    const Vec3f eye = wall + Vec3f{static_cast<float>(-0.5 * std::sin(angle)),
                                   0,
                                   static_cast<float>(-0.5 * std::cos(angle))};
    const Mean mean = film_mean(
        render_scene(scene, {}, look_at(eye, wall, 0.02f, image_size, image_size), options).film);
    const BsdfParams<double> p = exact_bsdf(m);
    const auto source = [&](double cosine) {
        double light = static_cast<double>(m.emission[0]);
        if (lamp_inside) {
            light +=
                intensity * evaluate_bsdf(p, polar_direction(cosine, 0), {0, 0, 1}).value_cos.x;
        }
        return light;
    };
    const std::vector<double> radiance = solve_sphere(p, source);
    const double position = std::cos(angle) * 64 - 0.5;
    const auto low = static_cast<size_t>(position);
    const double expected =
        radiance[low] + (position - static_cast<double>(low)) * (radiance[low + 1] - radiance[low]);
    expect_close(mean, expected);
}

TEST(ClosedSphere, PointLightAtTheCentreGivesTheIntegralEquationsRadiance) {
    Material m = white(0, 1);
    std::fill_n(m.base_color, 3, 0.5f);
    check_closed_sphere(m, true);
}

TEST(ClosedSphere, GlowingWallsGiveTheIntegralEquationsRadiance) {
    Material m = white(0, 0.8f);
    std::fill_n(m.base_color, 3, 0.5f);
    std::fill_n(m.emission, 3, 1.0f);
    check_closed_sphere(m, false);
}

TEST(AlphaBlend, LetsLightThroughInProportion) {
    for (const int layers : {1, 2}) {
        SceneBuilder builder;
        Material veil = white(0, 1);
        std::fill_n(veil.base_color, 3, 0.0f);
        veil.base_color[3] = 0.25f;
        veil.flags = material_alpha_blend;
        Material ground = white(0, 1);
        ground.base_color[0] = 0.5f;
        builder.quad({-100, 0, 100}, {200, 0, 0}, {0, 0, -200}, builder.material(ground));
        const int32_t index = builder.material(veil);
        for (int i = 0; i < layers; ++i) {
            // Above the floor, out of the camera's way: only shadow rays pass it.
            builder.quad({-50, 1.0f + static_cast<float>(i), 50}, {100, 0, 0}, {0, 0, -100}, index);
        }
        Scene scene = builder.take();
        PunctualLight sun;
        sun.type = static_cast<int32_t>(PunctualType::directional);
        sun.direction[1] = -1;
        sun.direction[2] = 0;
        std::fill_n(sun.intensity, 3, 3.0f);
        scene.lights.push_back(sun);
        RenderOptions options = small_image();
        options.integrator = Integrator::direct;
        const Camera camera = look_at({0, 0.5f, 0}, {0, 0, 0}, 0.1f, image_size, image_size);
        const Mean mean = film_mean(render_scene(scene, {}, camera, options).film);
        const double f = evaluate_bsdf(exact_bsdf(ground), {0, 0, 1}, {0, 0, 1}).value_cos.x;
        expect_close(mean, 3.0 * f * std::pow(0.75, layers));
    }
}

TEST(Environment, FollowsTheDocumentedOrientation) {
    // Every pixel of the map holds its own (u, v).
    ImageRgb32f map{256, 128, {}};
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            map.pixels.push_back((static_cast<float>(x) + 0.5f) / 256.0f);
            map.pixels.push_back((static_cast<float>(y) + 0.5f) / 128.0f);
            map.pixels.push_back(1.0f);
        }
    }
    for (const Vec3f& d : {Vec3f{1, 0, 0}, Vec3f{0, 0.2f, 1}, Vec3f{0.3f, -0.9f, -0.5f}}) {
        LightingOptions lighting;
        lighting.environment = shared(map);
        RenderOptions options = small_image();
        options.samples_per_pixel = 4;
        const Camera camera = look_at({0, 0, 0}, d, 0.01f, image_size, image_size);
        const Film film = render_scene(SceneBuilder().take(), lighting, camera, options).film;
        const Vec3f n = normalize(d);
        EXPECT_NEAR(film_mean(film, 0).value, std::atan2(n.z, n.x) / (2 * pi_d) + 0.5, 1e-3);
        EXPECT_NEAR(film_mean(film, 1).value, std::acos(n.y) / pi_d, 1e-3);
    }
}

}  // namespace known_radiance_truth
}  // namespace obscura::test
