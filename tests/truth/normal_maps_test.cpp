// tests/truth/normal_maps_test.cpp - normal maps from afar reflect as the mean of their normals.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/arena_images.h"
#include "support/random.h"
#include "support/scene_builder.h"
#include "truth/reference.h"
#include <array>

namespace obscura::test {
namespace normal_maps_truth {

constexpr int map_side = 128;  ///< texels
constexpr float half_side_m = 0.01f;
constexpr float lamp_height_m = 50, lamp_half_m = 5, lamp_nits = 10;

/// Codes of normals: straight up, and ones that mirror the lamp's inside, edge and outside.
constexpr std::array<uint32_t, 6> normal_codes = {
    0xFFFF8080U, 0xFFFE8488U, 0xFFFE7A77U, 0xFFFD8F80U, 0xFFFA6A90U, 0xFFF3A474U};

uint32_t code_at(int x, int y) {
    static const std::vector<uint32_t> codes = [] {
        Pcg32 random(21);
        std::vector<uint32_t> drawn(map_side * map_side);
        for (uint32_t& code : drawn)
            code = normal_codes[random.next_uint() % normal_codes.size()];
        return drawn;
    }();
    return codes[static_cast<size_t>(y * map_side + x)];
}

Vec3d normal_of(uint32_t code) {
    const auto part = [&](int shift) { return 2.0 * (code >> shift & 255U) / 255.0 - 1.0; };
    return normalize(Vec3d{part(0), part(8), part(16)});
}

Material polished_metal() {
    Material m;
    m.roughness = 0.15f;
    m.normal_texture.texture = 0;
    return m;
}

/// The same as a coat over black.
void coat(Scene& scene) {
    MaterialLayers layers;
    layers.clearcoat = 1;
    layers.specular = 0;
    layers.clearcoat_roughness = 0.15f;
    layers.clearcoat_normal_texture.texture = 0;
    scene.layers = {layers};
    Material& m = scene.materials[0];
    m.layers = 0;
    m.metallic = 0;
    m.normal_texture.texture = -1;
    std::fill_n(m.base_color, 3, 0.0f);
}

/// What a plate whose normals are all tilted towards +X mirrors of a sun, from one side or, all
/// else turned through the origin, from the other.
double seen_of_tilted(const Material& plate, bool has_coat, bool from_behind) {
    SceneBuilder builder;
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(plate));
    Scene scene = builder.take();
    if (has_coat) coat(scene);
    scene.materials[0].flags |= material_double_sided;
    add_image(scene.textures,
              1,
              pack_sampler(Wrap::repeat, Wrap::repeat, false, false, MipMode::linear, false),
              [](int, int) { return 0xFFE080C0U; });
    scene.primitives[0].uv_base[0] = 0;
    scene.primitives[0].tangent_base = 8;
    scene.attributes = {0, 1, 1, 1, 1, 0, 0, 0};
    for (int corner = 0; corner < 4; ++corner)
        scene.attributes.insert(scene.attributes.end(), {1, 0, 0, 1});
    const float side = from_behind ? -1.0f : 1.0f;
    PunctualLight sun;
    sun.type = static_cast<int32_t>(PunctualType::directional);
    sun.direction[0] = -0.92f * side;
    sun.direction[2] = -0.39f * side;
    std::fill_n(sun.intensity, 3, 10.0f);
    scene.lights = {sun};
    RenderOptions options;
    options.width = options.height = 8;
    options.samples_per_pixel = 4;
    options.max_bounces = 0;
    const Camera camera = look_at({0, 0, 1000 * side}, {0, 0, 0}, 1e-4f, 8, 8);
    return film_mean(render_scene(std::move(scene), {}, camera, options).film).value;
}

/// A small plate with the normal map, far below a square lamp.
Scene plate_under_a_lamp(const Material& plate) {
    SceneBuilder builder;
    builder.quad({-half_side_m, -half_side_m, 0},
                 {2 * half_side_m, 0, 0},
                 {0, 2 * half_side_m, 0},
                 builder.material(plate));
    Material lamp;
    lamp.metallic = 0;
    std::fill_n(lamp.base_color, 3, 0.0f);
    std::fill_n(lamp.emission, 3, lamp_nits);
    builder.quad({-lamp_half_m, lamp_half_m, lamp_height_m},
                 {2 * lamp_half_m, 0, 0},
                 {0, -2 * lamp_half_m, 0},
                 builder.material(lamp));
    Scene scene = builder.take();
    add_image(scene.textures,
              map_side,
              pack_sampler(Wrap::repeat, Wrap::repeat, false, false, MipMode::linear, false),
              code_at);
    Primitive& primitive = scene.primitives[0];
    primitive.uv_base[0] = 0;
    primitive.tangent_base = 8;
    scene.attributes = {0, 1, 1, 1, 1, 0, 0, 0};
    for (int corner = 0; corner < 4; ++corner)
        scene.attributes.insert(scene.attributes.end(), {1, 0, 0, 1});
    return scene;
}

/// The plate's mean radiance seen straight from above, by a film of so many pixels a side.
Mean seen_from_above(Scene scene, int pixels) {
    RenderOptions options;
    options.width = options.height = pixels;
    options.samples_per_pixel = (1 << 18) / (pixels * pixels);
    options.max_bounces = 0;
    Camera camera = look_at({0, 0, 1}, {0, 0, 0}, 1, pixels, pixels);
    camera.model = CameraModel::orthographic;
    camera.orthographic.half_width_m = camera.orthographic.half_height_m = half_side_m;
    camera.orthographic.pixel_width_m = 2 * half_side_m / static_cast<float>(pixels);
    return film_mean(render_scene(std::move(scene), {}, camera, options).film);
}

/// By quadrature over the lamp of the reflection at each of the map's normals.
double expected_radiance(const Material& m) {
    std::array<double, normal_codes.size()> share{};
    for (int y = 0; y < map_side; ++y) {
        for (int x = 0; x < map_side; ++x) {
            const auto code = std::find(normal_codes.begin(), normal_codes.end(), code_at(x, y));
            share[static_cast<size_t>(code - normal_codes.begin())] += 1.0 / (map_side * map_side);
        }
    }
    double sum = 0;
    for (size_t i = 0; i < normal_codes.size(); ++i) {
        const Frame<double> frame = frame_around(normal_of(normal_codes[i]));
        const auto incoming = [&](const Vec3d& wi) {
            const Vec3d world = to_world(frame, wi);
            const double scale = lamp_height_m / world.z;
            const bool met = world.z > 0 && std::abs(world.x * scale) < lamp_half_m &&
                             std::abs(world.y * scale) < lamp_half_m;
            return met ? static_cast<double>(lamp_nits) : 0.0;
        };
        sum += share[i] * reflected(exact_bsdf(m), to_local(frame, Vec3d{0, 0, 1}), incoming);
    }
    return sum;
}

TEST(NormalMaps, ReflectAsMuchFromAnyDistance) {
    const Material metal = polished_metal();
    const double expected = expected_radiance(metal);
    EXPECT_GT(expected, 0.1 * static_cast<double>(lamp_nits)) << "the case tells nothing";
    EXPECT_LT(expected, 0.8 * static_cast<double>(lamp_nits)) << "the case tells nothing";
    for (const int pixels : {128, 64, 16, 2})
        EXPECT_NEAR(
            seen_from_above(plate_under_a_lamp(metal), pixels).value, expected, 0.01 * expected)
            << map_side / pixels << " texels a pixel";
}

/// Seen from behind, normals are reversed: glTF 2.0, section 3.9.6.
TEST(NormalMaps, AreReversedOnBackFacesAndSoAreThoseOfCoats) {
    for (const bool has_coat : {false, true}) {
        const double front = seen_of_tilted(polished_metal(), has_coat, false);
        EXPECT_GT(front, 0.1) << has_coat;
        EXPECT_NEAR(seen_of_tilted(polished_metal(), has_coat, true), front, 0.01 * front);
    }
}

TEST(NormalMaps, OfCoatsToo) {
    const auto seen = [](int pixels) {
        Scene scene = plate_under_a_lamp(polished_metal());
        coat(scene);
        return seen_from_above(std::move(scene), pixels).value;
    };
    const double near = seen(map_side);
    EXPECT_GT(near, 0.005 * static_cast<double>(lamp_nits));
    EXPECT_LT(near, 0.035 * static_cast<double>(lamp_nits)) << "as if it were smooth";
    for (const int pixels : {64, 16, 2})
        EXPECT_NEAR(seen(pixels), near, 0.02 * near) << map_side / pixels << " texels a pixel";
}

}  // namespace normal_maps_truth
}  // namespace obscura::test
