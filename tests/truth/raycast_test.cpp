// tests/truth/raycast_test.cpp - ray casting against radiances worked out by hand, pixel by pixel.
// SPDX-License-Identifier: Apache-2.0
#include "camera/camera_models.h"
#include "camera/closed_rays.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace raycast_truth {

constexpr int side = 48;

RenderOptions raycast_options() {
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.integrator = Integrator::raycast;
    return options;
}

Material rough(float color) {
    Material m;
    std::fill_n(m.base_color, 3, color);
    m.metallic = 0;
    m.roughness = 1;
    return m;
}

Material lamp(float radiance) {
    Material m = rough(0);
    std::fill_n(m.emission, 3, radiance);
    return m;
}

PunctualLight bulb(const Vec3f& place, float candela) {
    PunctualLight light;
    light.position[0] = place.x;
    light.position[1] = place.y;
    light.position[2] = place.z;
    std::fill_n(light.intensity, 3, candela);
    return light;
}

/// A floor of 8 m.
SceneBuilder floor_builder(const Material& m) {
    SceneBuilder builder;
    builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(m));
    return builder;
}

/// In the floor's frame the normal is z: (x, y, z) of the world becomes (z, x, y).
Vec3d floor_local(const Vec3d& v) {
    return {v.z, v.x, v.y};
}

/// Where a pixel's centre looks at the floor y = 0.
Vec3d floor_point(const Camera& camera, int x, int y) {
    const ClosedRay ray = closed_ray(camera, {x, y, side, side});
    return ray.origin + ray.direction * (-ray.origin.y / ray.direction.y);
}

/// Radiance of the floor under a point light: f(wo, wi) cos I / d^2.
double lit(const Material& m, const Vec3d& eye, const Vec3d& at, const Vec3d& light, double i) {
    const Vec3d to_light = light - at;
    const Vec3d wi = normalize(to_light);
    const Vec3d wo = normalize(eye - at);
    const double f_cos = evaluate_bsdf(exact_bsdf(m), floor_local(wo), floor_local(wi)).value_cos.x;
    return f_cos * i / dot(to_light, to_light);
}

TEST(Raycast, FloorUnderAPointLightAndItsHardShadow) {
    const Material ground = rough(0.8f);
    SceneBuilder builder = floor_builder(ground);
    // A roof of 1 m x 0.8 m, 1 m above the floor and outside the image; the light is at 3 m, so
    // its shadow is larger by 3 / 2 and moved away from the light.
    const Vec3f light{0.5f, 3, -0.25f};
    builder.quad({-0.5f, 1, 0.4f}, {1, 0, 0}, {0, 0, -0.8f}, builder.material(rough(0.1f)));
    Scene scene = builder.take();
    scene.lights.push_back(bulb(light, 20));
    const Vec3f eye{0, 0.9f, 3};
    const Camera camera = look_at(eye, {-0.2f, 0, 0.2f}, 0.3f, side, side);
    const Film film = render_scene(std::move(scene), {}, camera, raycast_options()).film;
    int dark = 0;
    for (int i = 0; i < side * side; ++i) {
        const Vec3d at = floor_point(camera, i % side, i / side);
        ASSERT_TRUE(at.z > -4 && at.z < 3) << "the picture is full of floor";
        // The shadow ray passes the roof's height after a third.
        const Vec3d pierced = at + (Vec3d{0.5, 3, -0.25} - at) * (1.0 / 3);
        const double inside = std::min(0.5 - std::fabs(pierced.x), 0.4 - std::fabs(pierced.z));
        if (std::fabs(inside) < 1e-5) continue;
        const double expected = inside > 0 ? 0 : lit(ground, widen(eye), at, {0.5, 3, -0.25}, 20);
        ASSERT_NEAR(film.pixels[4 * static_cast<size_t>(i)], expected, 2e-5 * expected)
            << i % side << " " << i / side;
        dark += inside > 0 ? 1 : 0;
    }
    EXPECT_GT(dark, 50);
    EXPECT_LT(dark, side * side - 50);
}

TEST(Raycast, WithoutSpecularReflectionItIsLambertsLaw) {
    // Where the microfacet lobe is known, what remains is base / pi cos I / d^2, less what the lobe
    // has taken.
    const Material ground = rough(0.8f);
    Scene scene = floor_builder(ground).take();
    scene.lights.push_back(bulb({0, 2, 0}, 12));
    const Camera camera = look_at({0, 500, 0}, {0, 0, 0}, 0.008f, side, side);
    const Film film = render_scene(std::move(scene), {}, camera, raycast_options()).film;
    const BsdfParams<double> params = exact_bsdf(ground);
    const double left = 1 - dielectric_lobe(specular_albedo(1.0, params.alpha)).albedo;
    for (int i = 0; i < side * side; i += 7) {
        const Vec3d at = floor_point(camera, i % side, i / side);
        const double d2 = dot(at, at) + 4;
        const double cosine = 2 / std::sqrt(d2);
        const double lambert = left * 0.8 / pi_d * cosine * 12 / d2;
        BsdfParams<double> black = params;
        black.base_color = {0, 0, 0};
        const Vec3d wi = normalize(Vec3d{-at.z, -at.x, 2});
        const double specular = evaluate_bsdf(black, {0, 0, 1}, wi).value_cos.x * 12 / d2;
        ASSERT_NEAR(film.pixels[4 * static_cast<size_t>(i)], lambert + specular, 1e-3 * lambert);
    }
}

TEST(Raycast, NothingButTheSceneDecides) {
    const auto image = [](int spp, uint64_t seed, int tile, PixelFilter filter) {
        SceneBuilder builder = floor_builder(rough(0.5f));
        builder.sphere({0, 1, 0}, 1, 20, builder.material(rough(0.9f)));
        builder.quad({1, 3, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, builder.material(lamp(20)));
        Scene scene = builder.take();
        scene.lights.push_back(bulb({-2, 4, 2}, 30));
        RenderOptions options = raycast_options();
        options.samples_per_pixel = spp;
        options.seed = seed;
        options.tile_size = tile;
        options.filter = filter;
        const Camera camera = look_at({0, 2, 7}, {0, 1, 0}, 0.6f, side, side);
        return render_scene(std::move(scene), {}, camera, options).film.pixels;
    };
    const auto one = image(1, 0, 16, PixelFilter::box);
    EXPECT_EQ(one, image(64, 9, 5, PixelFilter::gaussian));
    EXPECT_GT(*std::max_element(one.begin(), one.end()), 0.1f);
}

TEST(Raycast, MoreLightsThanAShadowBatchHoldsAddUp) {
    const auto radiance = [](int lights) {
        Scene scene = floor_builder(rough(0.8f)).take();
        for (int i = 0; i < lights; ++i)
            scene.lights.push_back(bulb({0, 2, 0}, 30.0f / static_cast<float>(lights)));
        const Camera camera = look_at({0, 3, 3}, {0, 0, 0}, 0.5f, side, side);
        return render_scene(std::move(scene), {}, camera, raycast_options());
    };
    const RenderResult one = radiance(1);
    const RenderResult many = radiance(700);
    EXPECT_EQ(many.counters.shadow_rays, 700 * one.counters.shadow_rays);
    for (size_t i = 0; i < one.film.pixels.size(); ++i)
        ASSERT_NEAR(one.film.pixels[i], many.film.pixels[i], 2e-4f * one.film.pixels[i]) << i;
}

/// Radiance of the floor's middle, seen from afar, under one lamp of radiance 10.
double under_lamp(const Scene& scene) {
    const Camera camera = look_at({0, 500, 866}, {0, 0, 0}, 1e-5f, side, side);
    return film_mean(render_scene(scene, {}, camera, raycast_options()).film).value;
}

TEST(Raycast, LampsShineFromTheirCentre) {
    const Material ground = rough(0.8f);
    const double distance = 3;
    const auto expected = [&](double intensity) {
        const Vec3d wo = normalize(Vec3d{866, 0, 500});
        return evaluate_bsdf(exact_bsdf(ground), wo, {0, 0, 1}).value_cos.x * intensity /
               (distance * distance);
    };
    SceneBuilder flat = floor_builder(ground);
    flat.quad({-0.5f, 3, -0.25f}, {1, 0, 0}, {0, 0, 0.5f}, flat.material(lamp(10)));
    EXPECT_NEAR(under_lamp(flat.take()), expected(10 * 0.5), 1e-4);

    SceneBuilder turned = floor_builder(ground);  // shows its back
    turned.quad({-0.5f, 3, 0.25f}, {1, 0, 0}, {0, 0, -0.5f}, turned.material(lamp(10)));
    EXPECT_EQ(under_lamp(turned.take()), 0);

    SceneBuilder ball = floor_builder(ground);
    ball.sphere({0, 3, 0}, 0.25f, 60, ball.material(lamp(10)));
    const double disk = pi_d * 0.0625;
    EXPECT_NEAR(under_lamp(ball.take()), expected(10 * disk), 0.005 * expected(10 * disk));

    Scene shape = floor_builder(ground).take();
    shape.materials.push_back(lamp(10));
    shape.material_numbers.push_back(1);
    ShapeRecord record = make_shape(ShapeKind::sphere, 0.25f);
    record.centre[1] = 3;
    add_shape(shape, record, 1);
    EXPECT_NEAR(under_lamp(shape), expected(10 * disk), 1e-4);
}

TEST(Raycast, AConstantSkyMakesAWhiteFloorAsBright) {
    Scene scene = floor_builder(rough(1)).take();
    LightingOptions lighting;
    lighting.environment = constant_environment(1.5f);
    const Camera camera = look_at({0, 3, 3}, {0, 0, 0}, 0.5f, side, side);
    const Film film = render_scene(std::move(scene), lighting, camera, raycast_options()).film;
    for (size_t i = 0; i < film.pixels.size(); i += 4)
        ASSERT_NEAR(film.pixels[i], 1.5f, 0.01f);
}

TEST(Raycast, NoSceneIsBlack) {
    const Camera camera = look_at({0, 3, 3}, {0, 0, 0}, 0.5f, side, side);
    const Film studio =
        render_scene(floor_builder(rough(0.8f)).take(), {}, camera, raycast_options()).film;
    EXPECT_GT(film_mean(studio).value, 0.1);

    // A glowing box is not in the light table: then there is a light at the eye.
    Scene scene = floor_builder(rough(0.8f)).take();
    scene.materials.push_back(lamp(10));
    scene.material_numbers.push_back(1);
    ShapeRecord record = make_shape(ShapeKind::box, 0.1f, 0.1f, 0.1f);
    record.centre[1] = -5;
    add_shape(scene, record, 1);
    const Camera above = look_at({0, 500, 0}, {0, 0, 0}, 1e-4f, side, side);
    const Film head = render_scene(std::move(scene), {}, above, raycast_options()).film;
    const double facing = evaluate_bsdf(exact_bsdf(rough(0.8f)), {0, 0, 1}, {0, 0, 1}).value_cos.x;
    EXPECT_NEAR(film_mean(head).value, facing * pi_d, 1e-4);
}

}  // namespace raycast_truth
}  // namespace obscura::test
