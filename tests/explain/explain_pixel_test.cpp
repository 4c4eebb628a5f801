// tests/explain/explain_pixel_test.cpp - the report of a pixel against the image and by hand.
// SPDX-License-Identifier: Apache-2.0
#include "explain/explain_pixel.h"

#include "camera/camera_models.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include "support/shape_scenes.h"
#include "support/xml_text.h"
#include <gmock/gmock.h>

namespace obscura::test {
namespace {

using testing::HasSubstr;

constexpr int side = 24;

PunctualLight bulb(const Vec3f& place, float candela) {
    PunctualLight light;
    light.position[0] = place.x;
    light.position[1] = place.y;
    light.position[2] = place.z;
    std::fill_n(light.intensity, 3, candela);
    return light;
}

Material matt(float grey, bool double_sided = true) {
    Material m;
    std::fill_n(m.base_color, 3, grey);
    m.metallic = 0;
    if (double_sided) m.flags = material_double_sided;
    return m;
}

/// A floor of two triangles, a ball of many, a shape in the world, one that is placed, and a line,
/// under two bulbs and a lamp.
Scene full_scene() {
    SceneBuilder builder;
    const int32_t white = builder.material(matt(0.8F));
    builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, white);
    builder.sphere({-1.5F, 1, 0}, 0.8F, 12, builder.material(matt(0.5F, false)));
    Material lamp = matt(0);
    std::fill_n(lamp.emission, 3, 4.0F);
    builder.quad({-0.5F, 3, -1}, {1, 0, 0}, {0, 0, 1}, builder.material(lamp));
    Scene scene = builder.take();
    ShapeRecord ball = make_shape(ShapeKind::sphere, 0.7F);
    ball.centre[0] = 1.2F;
    ball.centre[1] = 0.7F;
    add_shape(scene, ball, white);
    add_strip(scene, {{{-2, 0.5F, 1}}, {{0, 0.8F, 1.2F}}, {{2, 0.4F, 1}}}, 0.05F);
    Affined placing{{{0.5, 0, 0, 0}, {0, 0.8, 0, 0.8}, {0, 0, -0.6, -0.8}}};
    add_shape(scene, make_shape(ShapeKind::frustum, 1, 0.8F, 0.3F), white, placing);
    scene.lights = {bulb({1, 4, 3}, 30), bulb({-3, 2, 2}, 10)};
    return scene;
}

PreparedScene prepare(Scene scene) {
    Log log(Verbosity::quiet);
    auto prepared = PreparedScene::create(std::move(scene), {}, Isa::automatic, log);
    if (!prepared) throw std::runtime_error(prepared.error().message);
    return std::move(*prepared);
}

PixelTask task_for(const PreparedScene& scene, const Camera& camera, int x, int y) {
    PixelTask task;
    task.scene = &scene;
    task.camera = camera;
    task.options.width = side;
    task.options.height = side;
    task.pixel = {x, y, side, side};
    task.file = "scene.gltf";
    task.camera_name = "a camera";
    return task;
}

PixelReport explain(const PixelTask& task) {
    const Result<PixelReport> report = explain_pixel(task);
    if (!report) throw std::runtime_error(report.error().message);
    return *report;
}

Film image(const PreparedScene& scene, const Camera& camera, Integrator integrator) {
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.integrator = integrator;
    const std::atomic<bool> never = false;
    auto result = render(scene, camera, options, {}, never);
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(result->film);
}

TEST(ExplainPixel, TheSumIsThePixelOfRayCastingBitForBit) {
    const PreparedScene scene = prepare(full_scene());
    const Camera camera = look_at({0.5F, 2, 6}, {0, 0.6F, 0}, 0.7F, side, side);
    const Film film = image(scene, camera, Integrator::raycast);
    int lit = 0;
    int shadowed = 0;
    for (int i = 0; i < side * side; ++i) {
        const PixelReport report = explain(task_for(scene, camera, i % side, i / side));
        float sum[3] = {report.renderer.unshadowed.x,
                        report.renderer.unshadowed.y,
                        report.renderer.unshadowed.z};
        for (const LightContribution& light : report.lights) {
            sum[0] += light.noted.arrived.x;
            sum[1] += light.noted.arrived.y;
            sum[2] += light.noted.arrived.z;
            lit += length(light.noted.arrived) > 0 ? 1 : 0;
            shadowed += light.blocked_by.empty() ? 0 : 1;
        }
        if (!report.seen) continue;
        for (size_t c = 0; c < 3; ++c) {
            const float expected = film.pixels[4 * static_cast<size_t>(i) + c];
            ASSERT_EQ(report.rgba[c], expected) << i;
            ASSERT_EQ(sum[c], expected) << i;
        }
    }
    EXPECT_GT(lit, 300);
    EXPECT_GT(shadowed, 20);
}

TEST(ExplainPixel, DoublePrecisionAgreesWithTheRenderer) {
    const PreparedScene scene = prepare(full_scene());
    for (const NamedCamera& named : all_cameras()) {
        Camera camera = named.camera;
        camera.world_from_camera = {};
        const float eye[3] = {0.13F, 1.07F, 5.1F};
        for (int c = 0; c < 3; ++c)
            camera.world_from_camera.m[c][3] = eye[c];
        int seen = 0;
        int apart = 0;
        for (int i = 0; i < side * side; i += 5) {
            const PixelReport report = explain(task_for(scene, camera, i % side, i / side));
            apart += report.disagrees ? 1 : 0;
            if (!report.seen || report.disagrees) continue;
            ++seen;
            const Candidate& object = report.objects[report.seen->object];
            const double t = static_cast<double>(report.renderer.t);
            ASSERT_NEAR(object.t, t, 2e-5 * t) << named.name << " " << i << " " << object.name;
        }
        EXPECT_GE(seen, 2) << named.name;
        EXPECT_EQ(apart, 0) << named.name;
    }
}

TEST(ExplainPixel, ByHand) {
    // A ball of radius 1 at 5 m, a bulb 3 m above and in front of the nearest point: E = 36 / 18.
    Scene own = empty_scene(matt(0.8F));
    add_shape(own, make_shape(ShapeKind::sphere, 1), 0);
    own.lights = {bulb({0, 3, 4}, 36)};
    own.info.light_names = {"Bulb"};
    const PreparedScene scene = prepare(std::move(own));
    Camera camera;
    camera.world_from_camera.m[2][3] = 5;
    camera.model = CameraModel::orthographic;
    camera.orthographic = {1.2F, 1.2F, 0.1F};
    PixelTask task = task_for(scene, camera, 1, 1);
    task.options.width = task.options.height = 3;
    task.pixel = {1, 1, 3, 3};
    const PixelReport report = explain(task);
    ASSERT_TRUE(report.seen);
    EXPECT_EQ(report.objects.at(0).working.t, (std::vector<double>{4, 6}));
    EXPECT_NEAR(length(report.seen->position - Vec3d{0, 0, 1}), 0, 1e-15);
    EXPECT_NEAR(length(report.seen->normal - Vec3d{0, 0, 1}), 0, 1e-6);
    ASSERT_EQ(report.lights.size(), 1U);
    const LightContribution& light = report.lights[0];
    EXPECT_EQ(light.name, "light 0 'Bulb', point");
    EXPECT_NEAR(light.irradiance.x, 2, 1e-12);
    EXPECT_NEAR(light.cosine, std::sqrt(0.5), 1e-6);
    EXPECT_TRUE(light.blocked_by.empty());
    const std::string text = pixel_text(report);
    EXPECT_THAT(text, HasSubstr("D = b^2 - a c = 1\n"));
    EXPECT_THAT(text, HasSubstr("t = 4 and 6\n"));
    EXPECT_THAT(text, HasSubstr("E = I / d^2 = (2, 2, 2)"));
}

TEST(ExplainPixel, BacksOfSingleSidedFacesArePassed) {
    SceneBuilder builder;
    const int32_t single = builder.material(matt(0.5F, false));
    builder.quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, single);  // shows its back
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, single);
    Material leaf = matt(0.5F);
    leaf.flags |= material_alpha_mask;
    leaf.base_color[3] = 0.25F;
    builder.quad({-1, -1, 0.5F}, {2, 0, 0}, {0, 2, 0}, builder.material(leaf));
    const PreparedScene scene = prepare(builder.take());
    const Camera camera = look_at({0.2F, 0.1F, 4}, {0, 0, 0}, 0.3F, side, side);
    const PixelReport report = explain(task_for(scene, camera, 12, 12));
    ASSERT_TRUE(report.seen);
    ASSERT_GE(report.objects.size(), 3U);
    EXPECT_EQ(report.objects[0].note, "its back, and its material has one side");
    EXPECT_EQ(report.objects[1].note, "cut out there by alpha");
    EXPECT_EQ(report.objects[2].fate, Fate::seen);
    EXPECT_EQ(report.seen->object, 2U);
    EXPECT_FALSE(report.disagrees);
}

/// The centre of the image looks exactly along a square's edge: single precision sees it, double
/// precision with the eye's last bit does not, or the reverse. The report follows the image.
TEST(ExplainPixel, WhereRoundingDecidesTheImageIsExplained) {
    int decided = 0;
    for (int i = 0; i < 200; ++i) {
        SceneBuilder builder;
        builder.quad({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, builder.material(matt(0.5F)));
        Scene own = builder.take();
        own.lights = {bulb({0.5F, 0, 3}, 9)};
        const PreparedScene scene = prepare(std::move(own));
        const float turn = 0.7F + 0.003F * static_cast<float>(i);
        const Camera camera =
            look_at({3 * std::cos(turn), 0.5F, 3 * std::sin(turn)}, {0, 0, 0}, 0.3F, 3, 3);
        PixelTask task = task_for(scene, camera, 1, 1);
        task.options.width = task.options.height = 3;
        task.pixel = {1, 1, 3, 3};
        const PixelReport report = explain(task);
        ASSERT_EQ(report.seen.has_value(), report.renderer.primitive >= 0) << turn;
        if (!report.disagrees) continue;
        ++decided;
        EXPECT_FALSE(report.objects.at(0).note.empty());
        if (report.seen) {
            EXPECT_NEAR(length(report.seen->position), 0, 1e-5);
            EXPECT_NEAR(report.lights.at(0).distance_m, std::sqrt(9.25), 1e-5);
        }
    }
    EXPECT_GT(decided, 10);
}

TEST(ExplainPixel, OfManyObjectsThoseNearTheRayAreListed) {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 60, builder.material(matt(0.5F)));
    const PreparedScene scene = prepare(builder.take());
    const Camera camera = look_at({0.2F, 0.1F, 4}, {0, 0, 0}, 0.3F, side, side);
    PixelTask task = task_for(scene, camera, 12, 12);
    task.max_objects = 3;
    const PixelReport report = explain(task);
    EXPECT_EQ(report.objects.size(), 3U);
    EXPECT_EQ(report.objects[0].fate, Fate::seen);
    EXPECT_EQ(report.objects[1].fate, Fate::hidden);
    EXPECT_EQ(report.objects[2].fate, Fate::missed);
    EXPECT_GT(report.more_near, 0U);
    const size_t triangles = 60 * 2 * 60 * 2 - 2 * 2 * 60;
    EXPECT_EQ(report.objects.size() + report.more_near + report.elsewhere, triangles);
    EXPECT_GT(report.elsewhere, triangles / 2);
}

TEST(ExplainPixel, WhereACameraShowsNothingThereIsNoRay) {
    const PreparedScene scene = prepare(full_scene());
    Camera camera = fisheye_camera(FisheyeLaw::equidistant, 180, no_k);
    PixelTask task = task_for(scene, camera, 0, 0);
    task.draws = true;
    const PixelReport report = explain(task);
    EXPECT_FALSE(report.seen);
    EXPECT_THAT(pixel_text(report), HasSubstr("the camera shows nothing here: there is no ray"));
    EXPECT_TRUE(is_well_formed(report.drawing)) << report.drawing;
    EXPECT_EQ(report.rgba[3], 0);
}

TEST(ExplainPixel, DrawingsAreWellFormedAndShowWhatIsMet) {
    Scene named = full_scene();
    named.info.node_names = {"A <floor> & more"};
    named.primitives[0].node = 0;
    const PreparedScene scene = prepare(std::move(named));
    for (const NamedCamera& camera : all_cameras()) {
        Camera placed = camera.camera;
        placed.world_from_camera = {};
        placed.world_from_camera.m[1][3] = 1;
        placed.world_from_camera.m[2][3] = 5;
        for (const int y : {4, 14, 20}) {
            PixelTask task = task_for(scene, placed, 13, y);
            task.draws = true;
            const std::string svg = explain(task).drawing;
            ASSERT_TRUE(is_well_formed(svg)) << svg;
            ASSERT_EQ(svg.find("nan"), std::string::npos) << svg;
            ASSERT_EQ(svg.find("inf"), std::string::npos) << svg;
            ASSERT_LT(svg.size(), 400000U);
        }
    }
    PixelTask task = task_for(scene, look_at({0, 2, 6}, {0, 0, 2}, 0.4F, side, side), 12, 20);
    task.draws = true;
    EXPECT_THAT(explain(task).drawing, HasSubstr("A &lt;floor&gt; &amp; more"));
}

}  // namespace
}  // namespace obscura::test
