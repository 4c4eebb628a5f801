// tests/truth/points_lines_normals_test.cpp - points and lines with normals face where these say.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace points_lines_normals_truth {

constexpr int side = 48;
constexpr float brightness = 10;

Material plaster(float grey) {
    Material m;
    m.metallic = 0;
    m.roughness = 1;
    std::fill_n(m.base_color, 3, grey);
    return m;
}

/// Gives the last primitive the normals of its vertices, in their order.
void set_normals(Scene& scene, const std::vector<Vec3f>& normals) {
    Primitive& primitive = scene.primitives.back();
    const bool points = primitive.geometry == static_cast<int32_t>(GeometryKind::spheres);
    const auto first =
        points ? static_cast<size_t>(primitive.first_triangle)
               : static_cast<size_t>(
                     scene.curve_segments[static_cast<size_t>(primitive.first_triangle)]);
    primitive.normal_base = static_cast<int32_t>(static_cast<int64_t>(scene.attributes.size()) -
                                                 3 * static_cast<int64_t>(first));
    for (const Vec3f& n : normals)
        scene.attributes.insert(scene.attributes.end(), {n.x, n.y, n.z});
    scene.attributes.resize(scene.attributes.size() + 4);  // gathers read four words
}

/// A large point, or a line that is as thick, seen so near that it fills the image.
Scene point_or_line(bool line, const Vec3f& normal, const Material& material) {
    Scene scene = empty_scene(material);
    if (line) {
        add_strip(scene, {{{0, -9, 0}}, {{0, 9, 0}}}, 1);
        set_normals(scene, {normal, normal});
    } else {
        add_points(scene, {{{0, 0, 0}}}, 1);
        set_normals(scene, {normal});
    }
    return scene;
}

struct View {
    Vec3f eye = {0, 0, 8};
    int bounces = 0;
    int samples = 16;
    Integrator integrator = Integrator::path;
    float sky = 0;
    float yfov_rad = 0.12f;
};

Film seen(Scene scene, const View& view) {
    RenderOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = view.samples;
    options.max_bounces = view.bounces;
    options.integrator = view.integrator;
    LightingOptions lighting;
    lighting.environment = constant_environment(view.sky);
    const Camera camera = look_at(view.eye, {0, 0, 0}, view.yfov_rad, side, side);
    return render_scene(std::move(scene), lighting, camera, options).film;
}

/// Light that comes from `from`.
PunctualLight sun(const Vec3f& from) {
    PunctualLight light;
    light.type = static_cast<int32_t>(PunctualType::directional);
    light.direction[0] = -from.x;
    light.direction[1] = -from.y;
    light.direction[2] = -from.z;
    std::fill_n(light.intensity, 3, brightness);
    return light;
}

/// Every pixel is as bright as a flat surface with the normal, wherever the round surface was hit:
/// at grazing angles, and in its own shadow.
TEST(PointsLinesNormals, DecideHowLightFalls) {
    const Material grey = plaster(0.5f);
    const Vec3f from = normalize(Vec3f{1, 0, 0.4f});
    for (const bool line : {false, true}) {
        const Vec3f normal = normalize(line ? Vec3f{0.6f, 0, 1} : Vec3f{0.4f, 0.5f, 1});
        Scene scene = point_or_line(line, normal, grey);
        scene.lights.push_back(sun(from));
        for (const Integrator integrator : {Integrator::path, Integrator::raycast}) {
            const Film film = seen(scene, {.integrator = integrator});
            const Vec3d n{normal.x, normal.y, normal.z};
            const Frame<double> frame = frame_around(n);
            for (const int pixel : {0, side / 2, side * side / 2 + 3, side * side - 1}) {
                const Vec3f target{(static_cast<float>(pixel % side) + 0.5f) / side - 0.5f,
                                   0.5f - (static_cast<float>(pixel) / side + 0.5f) / side,
                                   0};
                const Vec3f to_eye = normalize(Vec3f{0, 0, 8} - target * 0.96f);
                const Vec3d wo = to_local(frame, Vec3d{to_eye.x, to_eye.y, to_eye.z});
                const Vec3d wi = to_local(frame, Vec3d{from.x, from.y, from.z});
                const double expected = evaluate_bsdf(exact_bsdf(grey), wo, wi).value_cos.x *
                                        static_cast<double>(brightness);
                EXPECT_NEAR(film.pixels[static_cast<size_t>(pixel) * 4], expected, 0.01 * expected)
                    << line << " " << pixel;
            }
        }
    }
}

TEST(PointsLinesNormals, AreSeenFromBothSides) {
    const Material grey = plaster(0.5f);
    for (const bool line : {false, true}) {
        Scene towards = point_or_line(line, {0, 0, 1}, grey);
        Scene away = point_or_line(line, {0, 0, -1}, grey);
        for (Scene* scene : {&towards, &away})
            scene->lights.push_back(sun({0, 0, 1}));
        const double bright = film_mean(seen(towards, {})).value;
        EXPECT_GT(bright, 1);
        EXPECT_NEAR(film_mean(seen(away, {})).value, bright, 1e-4 * bright);
        // Lit from behind, both are dark.
        for (Scene* scene : {&towards, &away}) {
            scene->lights[0] = sun({0, 0, -1});
            EXPECT_EQ(film_mean(seen(*scene, {})).value, 0);
        }
    }
}

TEST(PointsLinesNormals, TurnFromOneEndOfALineToTheOther) {
    Scene scene = empty_scene(plaster(0.5f));
    add_strip(scene, {{{-4, 0, 0}}, {{4, 0, 0}}}, 1);
    set_normals(scene, {{0, 1, 0}, {0, 0, 1}});
    const Film film = seen(scene, {.samples = 1, .integrator = Integrator::normal, .yfov_rad = 1});
    const size_t row = side / 2 * side;
    for (const int x : {2, side / 2, side - 3}) {
        const size_t at = (row + static_cast<size_t>(x)) * 3;
        // Where the ray meets the line's front, one metre before its axis.
        const double place = (x + 0.5 - side / 2.0) / side * 2 * std::tan(0.5) * 7;
        const double fraction = (place + 4) / 8;
        const double size = std::hypot(1 - fraction, fraction);
        EXPECT_NEAR(film.pixels[at + 1], (1 - fraction) / size, 0.02) << x;
        EXPECT_NEAR(film.pixels[at + 2], fraction / size, 0.02) << x;
    }
}

/// Leaving rays begin outside, wherever the normal faces.
TEST(PointsLinesNormals, WhitePointsAndLinesVanishInAFurnace) {
    for (const bool line : {false, true}) {
        for (const Vec3f& normal :
             {Vec3f{0, 0, 1}, Vec3f{1, 0, 0.1f}, Vec3f{0.3f, 1, 0.2f}, Vec3f{0.001f, 1, 0}}) {
            const View view{.bounces = 50, .samples = 64, .sky = 1};
            const Mean mean =
                film_mean(seen(point_or_line(line, normalize(normal), plaster(1)), view));
            EXPECT_NEAR(mean.value, 1, 4 * mean.error + 0.02) << line << " " << normal.y;
        }
    }
}

TEST(PointsLinesNormals, WithoutLengthTheRoundSurfaceCounts) {
    for (const bool line : {false, true}) {
        Scene none = point_or_line(line, {0, 0, 0}, plaster(0.5f));
        Scene plain = none;
        plain.primitives.back().normal_base = no_attribute;
        const Film a = seen(none, {.sky = 1});
        const Film b = seen(plain, {.sky = 1});
        EXPECT_GT(film_mean(a).value, 0.1);
        for (size_t i = 0; i < a.pixels.size(); ++i)
            ASSERT_EQ(a.pixels[i], b.pixels[i]) << i;
    }
}

/// An instance that moves and stretches takes its points' normals along.
TEST(PointsLinesNormals, TurnWithTheirInstance) {
    Scene still = point_or_line(false, {0, 0, 1}, plaster(0.5f));
    Scene turned = point_or_line(false, {1, 0, 0}, plaster(0.5f));
    turned.world_primitive_count = 0;
    turned.meshes.push_back({0, 1});
    Instance instance;
    instance.world_from_object = {};
    auto& m = instance.world_from_object.m;  // x becomes z
    m[0][0] = m[2][2] = 0;
    m[2][0] = 1;
    m[0][2] = -1;
    instance.object_from_world = inverse(instance.world_from_object);
    turned.instances.push_back(instance);
    const Film a = seen(still, {.samples = 1, .integrator = Integrator::normal});
    const Film b = seen(turned, {.samples = 1, .integrator = Integrator::normal});
    for (size_t i = 0; i < a.pixels.size(); ++i)
        ASSERT_NEAR(a.pixels[i], b.pixels[i], 1e-6) << i;
    EXPECT_EQ(a.pixels[2], 1);
}

}  // namespace points_lines_normals_truth
}  // namespace obscura::test
