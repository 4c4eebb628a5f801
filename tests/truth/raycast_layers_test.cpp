// tests/truth/raycast_layers_test.cpp - ray casting of layered materials, against formulas.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "truth/dielectric_scene.h"

namespace obscura::test {
namespace raycast_layers_truth {

/// A floor of 8 m, the fronts above, of one material.
Scene layered_floor(float color, const MaterialLayers& layers) {
    DielectricScene solids;
    solids.builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, solids.add(layers));
    Scene scene = solids.take();
    std::fill_n(scene.materials[0].base_color, 3, color);
    scene.materials[0].roughness = 1;
    return scene;
}

/// From far away; all rays are parallel, but for a millionth.
Film seen(Scene scene, const Vec3d& towards_eye, Integrator integrator, float sky = 0) {
    RenderOptions options;
    options.width = options.height = image_size;
    options.integrator = integrator;
    options.samples_per_pixel = 256;
    LightingOptions lighting;
    if (sky > 0) lighting.environment = constant_environment(sky);
    const Vec3d place = towards_eye * 1000.0;
    const Vec3f eye{
        static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)};
    const Camera camera = look_at(eye, {0, 0, 0}, 1e-5f, image_size, image_size);
    return render_scene(std::move(scene), lighting, camera, options).film;
}

/// A sun of so many lux on surfaces that face it, in the plane z = 0.
PunctualLight sun(double angle, float lux) {
    PunctualLight light;
    light.type = static_cast<int32_t>(PunctualType::directional);
    light.direction[0] = static_cast<float>(-std::sin(angle));
    light.direction[1] = static_cast<float>(-std::cos(angle));
    light.direction[2] = 0;
    std::fill_n(light.intensity, 3, lux);
    return light;
}

/// D F V cos of the coat seen along its normal: GGX, Smith's height-correlated masking, Schlick's
/// Fresnel with index 1.5, as KHR_materials_clearcoat says, and what its facets reflect once more.
double coat_from_above(double roughness, double angle) {
    const double a2 = std::pow(roughness, 4);
    const double h = std::cos(angle / 2);
    const double i = std::cos(angle);
    const double distribution = a2 / (pi_d * square(h * h * (a2 - 1) + 1));
    const double visibility = 0.5 / (i + std::sqrt(a2 + (1 - a2) * i * i));
    const double gain = dielectric_lobe(specular_albedo(1.0, std::sqrt(a2))).factor;
    const double fresnel = 0.04 + 0.96 * std::pow(1 - h, 5);
    return gain * fresnel * distribution * visibility * i;
}

TEST(RaycastLayers, ACoatUnderASun) {
    MaterialLayers layers;
    layers.specular = 0;
    layers.clearcoat = 0.75f;
    layers.clearcoat_roughness = 0.4f;
    Material coat;
    coat.metallic = 0;
    coat.roughness = 0.4f;
    std::fill_n(coat.base_color, 3, 0.0f);
    const double reflects =
        reflected(exact_bsdf(coat), {0, 0, 1}, [](const Vec3d&) { return 1.0; });
    for (const double angle : {0.1, 0.5, 1.2}) {
        Scene scene = layered_floor(0.6f, layers);
        scene.lights.push_back(sun(angle, 20));
        const double below = (1 - 0.75 * reflects) * 0.6 / pi_d * std::cos(angle);
        const double expected = 20 * (0.75 * coat_from_above(0.4, angle) + below);
        const Film film = seen(std::move(scene), {0, 1, 0}, Integrator::raycast);
        EXPECT_NEAR(film_mean(film).value, expected, 1e-3 * expected) << angle;
    }
}

TEST(RaycastLayers, WhatLetsLightThroughIsLitFromBehind) {
    MaterialLayers paper;
    paper.specular = 0;
    paper.diffuse_transmission = 0.6f;
    std::fill_n(paper.diffuse_transmission_color, 3, 0.5f);
    const double angle = 0.4;
    Scene scene = layered_floor(0.9f, paper);
    scene.lights.push_back(sun(pi_d - angle, 20));  // from below
    const double expected = 20 * 0.6 * 0.5 / pi_d * std::cos(angle);
    const Film film = seen(scene, {0, 1, 0}, Integrator::raycast);
    EXPECT_NEAR(film_mean(film).value, expected, 1e-4 * expected);

    scene.layers[0].diffuse_transmission = 0;
    EXPECT_EQ(film_mean(seen(scene, {0, 1, 0}, Integrator::raycast)).value, 0);
}

TEST(RaycastLayers, AConstantSkyIsReflectedAsPathsFindIt) {
    std::vector<MaterialLayers> all(6);
    all[0].clearcoat = 1;
    all[0].clearcoat_roughness = 0.3f;
    all[1].sheen_color[0] = 0.8f;
    all[1].sheen_roughness = 0.5f;
    all[2].transmission = 0.7f;
    all[3].diffuse_transmission = 0.5f;
    std::fill_n(all[3].diffuse_transmission_color, 3, 0.3f);
    all[4].iridescence = 1;
    all[5].specular = 0.5f;
    all[5].ior = 2;
    for (const Vec3d& towards_eye : {Vec3d{0, 1, 0}, normalize(Vec3d{1, 0.6, 0.3})}) {
        for (size_t i = 0; i < all.size(); ++i) {
            const Scene scene = layered_floor(0.7f, all[i]);
            const Mean path = film_mean(seen(scene, towards_eye, Integrator::path, 1.5f));
            const Mean cast = film_mean(seen(scene, towards_eye, Integrator::raycast, 1.5f));
            // A thin film's reflectance is taken at the surface's own angle, not at its facets'.
            const double room = all[i].iridescence > 0 ? 0.04 : 0.02;
            EXPECT_NEAR(cast.value, path.value, room * path.value + 4 * path.error)
                << i << " " << towards_eye.y;
        }
    }
}

TEST(RaycastLayers, NoPixelHasAWavelengthOfItsOwn) {
    MaterialLayers glass = dielectric(1.7f, {0, 0, 0});
    Scene scene = layered_floor(1, glass);
    scene.materials[0].roughness = 0.5f;
    scene.lights.push_back(sun(0, 20));
    for (const double angle : {0.3, pi_d - 0.8}) {  // above; below, where the light is refracted
        scene.lights[0] = sun(angle, 20);
        scene.layers[0].dispersion = 5;
        const Film film = seen(scene, {0, 1, 0}, Integrator::raycast);
        scene.layers[0].dispersion = 0;
        const Film plain = seen(scene, {0, 1, 0}, Integrator::raycast);
        ASSERT_GT(plain.pixels[0], 0.0f);
        for (size_t i = 0; i < film.pixels.size(); i += 4) {
            ASSERT_NEAR(film.pixels[i], plain.pixels[i], 1e-4f * plain.pixels[i]) << angle;
            ASSERT_EQ(film.pixels[i], film.pixels[i + 2]);
        }
    }
}

}  // namespace raycast_layers_truth
}  // namespace obscura::test
