// tests/truth/cutaway_test.cpp - surfaces cut away for the camera do not shadow what it sees.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "support/thin_wall_scenes.h"
#include <functional>
#include <string>

namespace obscura::test {
namespace cutaway_truth {

constexpr int size = 24;

Material plaster(const Vec3f& color = {0.8f, 0.8f, 0.8f}) {
    Material m;
    m.metallic = 0;
    m.roughness = 1;
    m.base_color[0] = color.x;
    m.base_color[1] = color.y;
    m.base_color[2] = color.z;
    return m;
}

/// A camera and its settings.
struct View {
    int bounces = 0;
    Integrator integrator = Integrator::path;
    float sky = 1;
    bool parallel = false;
    float lens_radius_m = 0;
    std::vector<Affined> moving_camera = {};
    int strategies = sample_lights | sample_bsdfs;
    int samples = 16;
};

/// From high above the origin.
Film from_above(Scene scene, const View& view) {
    // How often a lamp is sampled, and hence the sky: for equal images.
    scene.bounds = {{-5, 0, -5}, {5, 5, 5}};
    RenderOptions options;
    options.width = options.height = size;
    options.samples_per_pixel = view.samples;
    options.max_bounces = view.bounces;
    options.ao_distance_m = 1;
    options.tile_size = 8;  // several tiles a thread: no state may be left from the tile before
    options.moving_camera = view.moving_camera;
    options.integrator = view.integrator;
    options.strategies = view.strategies;
    LightingOptions lighting;
    lighting.environment = constant_environment(view.sky);
    Camera camera = look_at({0, 20, 0}, {0, 0, 0}, 0.09f, size, size);
    if (view.parallel) {
        camera.model = CameraModel::orthographic;
        camera.orthographic.half_width_m = camera.orthographic.half_height_m = 0.9f;
    }
    if (!view.moving_camera.empty()) {
        camera.world_from_camera = affine_cast<float>(view.moving_camera[0]);
    }
    if (view.lens_radius_m > 0) {
        camera.model = CameraModel::thin_lens;
        camera.thin_lens.aperture.radius_m = view.lens_radius_m;
        camera.thin_lens.inverse_focus = 1.0f / 20;
    }
    return render_scene(std::move(scene), lighting, camera, options).film;
}

void expect_equal(const Film& a, const Film& b, const std::string& what) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    double sum = 0;
    size_t different = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        different += a.pixels[i] == b.pixels[i] ? 0 : 1;
        sum += static_cast<double>(b.pixels[i]);
    }
    EXPECT_EQ(different, 0U) << what;
    EXPECT_GT(sum, 1) << what;  // a black image would prove nothing
}

/// A roof over the floor that faces down: from above only its back is seen.
void add_roof(ThinWallScene& scene, float height, float half, int32_t index) {
    scene.builder.quad({-half, height, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, index);
}

Scene floor_with(const std::function<void(ThinWallScene&)>& add) {
    ThinWallScene scene;
    scene.light(lamp_at({0.4f, 3, 0.2f}));
    add(scene);
    return scene.take();
}

TEST(Cutaway, ARoofThatTheCameraLooksThroughCastsNoShadow) {
    const Scene open = floor_with([](ThinWallScene&) {});
    const Scene roofed =
        floor_with([](ThinWallScene& s) { add_roof(s, 0.3f, 5, s.builder.material(plaster())); });
    for (const bool parallel : {false, true}) {
        for (const int bounces : {0, 3}) {
            const View view{.bounces = bounces, .parallel = parallel};
            expect_equal(from_above(roofed, view), from_above(open, view), "path");
        }
        for (const Integrator i : {Integrator::raycast, Integrator::ao, Integrator::direct}) {
            const View view{.integrator = i, .parallel = parallel};
            expect_equal(from_above(roofed, view), from_above(open, view), "others");
        }
    }
}

/// The roof as an instance, placed by `places` while the shutter is open.
Scene with_instance(const std::vector<Affinef>& places) {
    Scene scene =
        floor_with([](ThinWallScene& s) { add_roof(s, 0.3f, 5, s.builder.material(plaster())); });
    place_last(scene, places);
    return scene;
}

TEST(Cutaway, InstancesAreCutAwayToo) {
    const Scene open = floor_with([](ThinWallScene&) {});
    const View view{.bounces = 2};
    const Film expected = from_above(open, view);
    expect_equal(
        from_above(with_instance({placing({2, 1, 1}, {0, 0.5f, 0})}), view), expected, "scaled");
    // Mirrored across: the same faces are fronts.
    expect_equal(
        from_above(with_instance({placing({-1, 1, 1}, {0, 0, 0})}), view), expected, "mirrored");
}

TEST(Cutaway, AMovingRoofIsCutAwayAsFarAsItsOwnTimeGoes) {
    // Every path has its own time; a still roof beside the moving one keeps their numbers alike.
    const std::vector<Affinef> moving = {placing({1, 1, 1}, {0, 0, 0}),
                                         placing({1, 1, 1}, {0, 0.4f, 0})};
    const std::vector<Affinef> far = {placing({1, 1, 1}, {0, -9, 0}),
                                      placing({1, 1, 1}, {0, -9.5f, 0})};
    const View view{.bounces = 2};
    expect_equal(
        from_above(with_instance(moving), view), from_above(with_instance(far), view), "moving");
}

/// Each path has its own cut-away faces: to others the roof is solid.
TEST(Cutaway, PathsBesideTheRoofAreInItsShadow) {
    const auto half_a_roof = [](uint32_t flags) {
        return floor_with([&](ThinWallScene& s) {
            Material m = plaster();
            m.flags |= flags;
            s.builder.quad({-5, 0.3f, -5}, {5, 0, 0}, {0, 0, 10}, s.builder.material(m));
        });
    };
    for (const int bounces : {0, 3}) {
        const View view{.bounces = bounces, .parallel = true};
        const Film cut = from_above(half_a_roof(0), view);
        const Film open = from_above(floor_with([](ThinWallScene&) {}), view);
        const Film solid = from_above(half_a_roof(material_double_sided), view);
        size_t shaded = 0;
        for (size_t i = 0; i < cut.pixels.size(); ++i) {
            const bool through = i / 4 % size >= size / 2;  // x grows to the left
            ASSERT_EQ(cut.pixels[i], through ? open.pixels[i] : solid.pixels[i]) << i;
            shaded += !through && solid.pixels[i] < open.pixels[i] ? 1 : 0;
        }
        EXPECT_GT(shaded, 100U);
    }
}

/// The roof's plane lies between the eye's positions: each path has its own.
TEST(Cutaway, EachPathHasItsOwnEye) {
    const auto build = [](bool roofed) {
        return floor_with([&](ThinWallScene& s) {
            // Upright, its front towards +x: only rays that meet its back look through it.
            const int32_t index = s.builder.material(plaster());
            if (roofed) s.builder.quad({0, 0.05f, -9}, {0, 9, 0}, {0, 0, 18}, index);
        });
    };
    // The camera goes past the plane of the wall.
    const Camera above = look_at({0, 20, 0}, {0, 0, 0}, 0.09f, size, size);
    const auto at = [&](double x) {
        Affined out = affine_cast<double>(above.world_from_camera);
        out.m[0][3] = x;
        return out;
    };
    const auto mean = [&](bool roofed, const std::vector<Affined>& way, float lens) {
        const View view{.lens_radius_m = lens, .moving_camera = way, .samples = 256};
        return film_mean(from_above(build(roofed), view)).value;
    };
    const double there = mean(true, {at(-2), at(2)}, 0);
    const double back = mean(true, {at(2), at(-2)}, 0);
    EXPECT_NEAR(there, back, 0.01 * there) << "the same places in the other order";
    EXPECT_LT(there, 0.99 * mean(false, {at(-2), at(2)}, 0));
}

/// A lens under which the roof is small sees through it everywhere.
TEST(Cutaway, LensesLookThroughToo) {
    const View view{.lens_radius_m = 0.5f};
    const Scene roofed =
        floor_with([](ThinWallScene& s) { add_roof(s, 0.3f, 5, s.builder.material(plaster())); });
    expect_equal(
        from_above(roofed, view), from_above(floor_with([](ThinWallScene&) {}), view), "lens");
}

/// An infinite plane cuts off what is behind it: a slanting sheet that faces down gives the same
/// shadow whether it ends at the plane or continues below.
TEST(Cutaway, BacksBehindInfinitePlanesStay) {
    const auto build = [](bool goes_on) {
        SceneBuilder builder;
        const int32_t index = builder.material(plaster());
        const float low = goes_on ? -1.0f : 0.0f;
        builder.quad({5, low, -0.5f * low}, {-10, 0, 0}, {0, 0.2f - low, 0.5f * low - 0.1f}, index);
        Scene scene = builder.take();
        add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), index);
        PunctualLight sun = slanting_sun();  // the shadow falls on what lies over the lower part
        sun.direction[0] = 0;
        sun.direction[1] = -0.6f;
        sun.direction[2] = 0.8f;
        scene.lights = {sun};
        return scene;
    };
    const View view{.integrator = Integrator::raycast, .sky = 0};
    const Film one = from_above(build(true), view);
    const Film other = from_above(build(false), view);
    size_t dark = 0;
    size_t different = 0;
    for (size_t i = 0; i < one.pixels.size(); i += 4) {
        dark += other.pixels[i] == 0 ? 1 : 0;
        different += std::fabs(one.pixels[i] - other.pixels[i]) > 1e-3f ? 1 : 0;
    }
    EXPECT_GT(dark, size * size / 20);
    EXPECT_LE(different, size);
}

TEST(Cutaway, ARoofOverTheCameraGivesShadow) {
    const Scene lit = floor_with([](ThinWallScene&) {});
    const Scene shaded =
        floor_with([](ThinWallScene& s) { add_roof(s, 25, 200, s.builder.material(plaster())); });
    const View view;
    EXPECT_LT(film_mean(from_above(shaded, view)).value,
              0.5 * film_mean(from_above(lit, view)).value);
}

/// A closed room whose fronts face inwards; without its ceiling where `open`.
Scene room(bool open, float ceiling_emission = 0) {
    SceneBuilder builder;
    const int32_t red = builder.material(plaster({0.9f, 0.1f, 0.1f}));
    Material white = plaster();
    std::fill_n(white.emission, 3, ceiling_emission);
    const int32_t top = ceiling_emission > 0 ? builder.material(white) : red;
    const float w = 1.2f;
    builder.quad({-w, 0, w}, {2 * w, 0, 0}, {0, 0, -2 * w}, red);
    builder.quad({-w, 0, w}, {0, 0, -2 * w}, {0, 1, 0}, red);
    builder.quad({w, 0, -w}, {0, 0, 2 * w}, {0, 1, 0}, red);
    builder.quad({-w, 0, -w}, {2 * w, 0, 0}, {0, 1, 0}, red);
    builder.quad({w, 0, w}, {-2 * w, 0, 0}, {0, 1, 0}, red);
    if (!open) builder.quad({-w, 1, -w}, {2 * w, 0, 0}, {0, 0, 2 * w}, top);
    Scene scene = builder.take();
    if (ceiling_emission > 0) return scene;
    // One surface: floor, walls and ceiling.
    Primitive whole = scene.primitives[0];
    whole.triangle_count = static_cast<int32_t>(scene.indices.size() / 3);
    scene.primitives = {whole};
    scene.world_primitive_count = 1;
    return scene;
}

TEST(Cutaway, OnlyWhatShowsItsBackToTheEyeIsTakenAway) {
    for (const bool parallel : {false, true}) {
        for (const int bounces : {0, 1, 5}) {
            const View view{.bounces = bounces, .parallel = parallel};
            expect_equal(from_above(room(false), view), from_above(room(true), view), "room");
        }
    }
}

TEST(Cutaway, WhatSendsOutLightStaysAndItsLightCountsOnce) {
    double seen[3];
    for (int i = 0; i < 3; ++i) {
        constexpr int strategies[] = {sample_lights, sample_bsdfs, sample_lights | sample_bsdfs};
        const View view{.sky = 0, .strategies = strategies[i], .samples = 1024};
        seen[i] = film_mean(from_above(room(false, 2), view)).value;
    }
    EXPECT_GT(seen[0], 0.1);
    EXPECT_NEAR(seen[1], seen[0], 0.01 * seen[0]);
    EXPECT_NEAR(seen[2], seen[0], 0.01 * seen[0]);
    // And the sky stays outside.
    const View with_sky{.sky = 1, .samples = 1024};
    EXPECT_NEAR(film_mean(from_above(room(false, 2), with_sky)).value, seen[0], 0.01 * seen[0]);
}

TEST(Cutaway, ShadowRaysGoOnThroughPanesAboveTheRoof) {
    const auto build = [](bool roof) {
        return floor_with([&](ThinWallScene& s) {
            // On edge to the camera, and between the lamp and half of the floor.
            s.builder.quad({0.3f, 0.35f, 5},
                           {0, 2.5f, 0},
                           {0, 0, -10},
                           s.add(glass_material(), glass_layers()));
            if (roof) add_roof(s, 0.3f, 5, s.builder.material(plaster()));
        });
    };
    for (const Integrator i : {Integrator::path, Integrator::raycast}) {
        const View view{.bounces = 0, .integrator = i, .sky = 0, .parallel = true};
        expect_equal(from_above(build(true), view), from_above(build(false), view), "pane");
    }
}

}  // namespace cutaway_truth
}  // namespace obscura::test
