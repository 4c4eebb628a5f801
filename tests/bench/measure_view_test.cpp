// tests/bench/measure_view_test.cpp - recorded rays, their replay, and the times of the stages.
// SPDX-License-Identifier: Apache-2.0
#include "bench/measure_view.h"

#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"
#include <gmock/gmock.h>
#include <numeric>

namespace obscura::bench {
namespace {

using namespace test;

/// Not that the rendering was short, which it is here.
std::vector<std::string> doubts_about_hits(ViewFigures view) {
    view.render_s = {};
    return doubts_about(view);
}

const std::atomic<bool> never_stop = false;

/// Two-sided spheres on a square, one half transparent; under a thin pane of glass, if asked.
PreparedScene some_scene(bool with_pane = false) {
    SceneBuilder builder;
    Material solid;
    solid.flags = material_double_sided;
    Material glass = solid;
    glass.flags |= material_alpha_blend;
    glass.base_color[3] = 0.5f;
    const int32_t solid_index = builder.material(solid);
    const int32_t glass_index = builder.material(glass);
    builder.quad({-3, -1, -3}, {0, 0, 6}, {6, 0, 0}, solid_index);
    builder.sphere({-1, 0, 0}, 0.8f, 12, solid_index);
    builder.sphere({1, 0, 0}, 0.8f, 12, glass_index);
    Material pane = glass_material();
    pane.layers = 0;
    if (with_pane) builder.quad({-3, 1.5f, 3}, {6, 0, 0}, {0, 0, -6}, builder.material(pane));
    Scene scene = builder.take();
    scene.layers = {glass_layers()};
    Log silent(Verbosity::quiet);
    auto prepared = PreparedScene::create(std::move(scene), {}, Isa::automatic, silent);
    EXPECT_TRUE(prepared);
    return std::move(*prepared);
}

Camera some_camera() {
    Camera camera;
    camera.world_from_camera.m[2][3] = 6;
    camera.pinhole.tan_half_yfov = 0.4f;
    camera.pinhole.aspect = 1.5f;
    return camera;
}

RenderOptions some_options(Integrator integrator = Integrator::path) {
    RenderOptions options;
    options.width = 48;
    options.height = 32;
    options.samples_per_pixel = 3;
    options.max_bounces = 4;
    options.integrator = integrator;
    return options;
}

TEST(Recording, LeavesTheImageAlone) {
    const PreparedScene scene = some_scene();
    RenderOptions options = some_options();
    const auto plain = render(scene, some_camera(), options, {}, never_stop);
    RayRecording recording;
    options.recording = &recording;
    const auto recorded = render(scene, some_camera(), options, {}, never_stop);
    ASSERT_TRUE(plain && recorded);
    EXPECT_EQ(plain->film.pixels, recorded->film.pixels);
    EXPECT_EQ(recording.count(RayKind::camera), plain->counters.camera_rays);
    EXPECT_EQ(recording.count(RayKind::bounce), plain->counters.bounce_rays);
    EXPECT_EQ(recording.count(RayKind::shadow), plain->counters.shadow_rays);
    EXPECT_GT(recording.count(RayKind::shadow), 0U);
}

void expect_replay_finds_all_hits(const PreparedScene& scene, const RayRecording& recording) {
    for (size_t k = 0; k < ray_kinds; ++k) {
        const auto kind = static_cast<RayKind>(k);
        for (const ReplayMode mode :
             {ReplayMode::single, ReplayMode::packets, ReplayMode::coherent_packets}) {
            const ReplayResult got = scene.accel().replay(recording, kind, mode);
            EXPECT_EQ(got.hits, recording.hits(kind))
                << ray_kind_names[k] << replay_mode_name(mode);
        }
    }
    EXPECT_GT(recording.hits(RayKind::camera), 0U);
}

TEST(Replay, FindsTheHitsOfTheRendering) {
    const PreparedScene scene = some_scene();
    for (const Integrator integrator : {Integrator::path, Integrator::ao, Integrator::normal}) {
        RayRecording recording;
        RenderOptions options = some_options(integrator);
        options.recording = &recording;
        ASSERT_TRUE(render(scene, some_camera(), options, {}, never_stop));
        expect_replay_finds_all_hits(scene, recording);
    }
}

TEST(Replay, ShadowRaysGoOnThroughPanes) {
    const PreparedScene scene = some_scene(true);
    RenderOptions options = some_options();
    RayRecording recording;
    options.recording = &recording;
    const auto rendered = render(scene, some_camera(), options, {}, never_stop);
    ASSERT_TRUE(rendered);
    uint64_t behind = 0;
    for (const auto& thread : recording.threads)
        behind += thread->shadow_hits().count();
    EXPECT_GT(behind, 100U);
    EXPECT_EQ(recording.count(RayKind::shadow), rendered->counters.shadow_rays);
    expect_replay_finds_all_hits(scene, recording);
}

TEST(MeasureView, CountsAndFractions) {
    const PreparedScene scene = some_scene();
    ViewTask task;
    task.scene = &scene;
    task.camera = some_camera();
    task.options = some_options();
    task.repeat = 2;
    task.threads = 1;
    int calls = 0;
    task.after_first = [&] { ++calls; };
    const Result<ViewFigures> view = measure_view(task, never_stop);
    ASSERT_TRUE(view);
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(view->counters.paths, 48U * 32U * 3U);
    EXPECT_EQ(view->kinds[0].rays, view->counters.camera_rays);
    EXPECT_TRUE(doubts_about_hits(*view).empty());
    const auto fractions = stage_fractions(*view);
    EXPECT_NEAR(std::accumulate(fractions.begin(), fractions.end(), 0.0), 1.0, 1e-12);
    for (const double fraction : fractions)
        EXPECT_GE(fraction, 0);
    EXPECT_GT(view->of_bare.median, 0);
    EXPECT_LE(view->of_bare.low, view->of_bare.median);
    EXPECT_LE(view->of_bare.median, view->of_bare.high);
}

TEST(MeasureView, StopsOnRequest) {
    const PreparedScene scene = some_scene();
    ViewTask task;
    task.scene = &scene;
    task.camera = some_camera();
    task.options = some_options();
    const std::atomic<bool> stop = true;
    const Result<ViewFigures> view = measure_view(task, stop);
    ASSERT_FALSE(view);
    EXPECT_EQ(view.error().id, "E-STOPPED");
}

/// Faces cut away for the rendering's shadow rays are hit by the replay: also behind panes.
TEST(MeasureView, CutAwayFacesAreNoReasonForDoubt) {
    for (const bool pane : {false, true}) {
        ThinWallScene walls;
        walls.light(slanting_sun());
        if (pane) walls.pane(1, walls.add(glass_material(), glass_layers()), 3);
        Material white;
        white.metallic = 0;
        walls.builder.quad({-4, 2, -4}, {8, 0, 0}, {0, 0, 8}, walls.builder.material(white));
        Log silent(Verbosity::quiet);
        const auto scene = PreparedScene::create(walls.take(), {}, Isa::automatic, silent);
        ASSERT_TRUE(scene);
        ViewTask task;
        task.scene = &*scene;
        task.camera = look_at({0, 8, 0}, {0, 0, 0}, 0.2f, 48, 32);
        task.options = some_options();
        task.repeat = 1;
        task.threads = 1;
        const Result<ViewFigures> view = measure_view(task, never_stop);
        ASSERT_TRUE(view);
        const KindFigures& shadow = view->kinds[static_cast<size_t>(RayKind::shadow)];
        EXPECT_GT(shadow.spared, 100U);
        EXPECT_GT(shadow.bare_hits, shadow.hits + 100) << "the replay knows no cutting away";
        EXPECT_THAT(doubts_about_hits(*view), testing::IsEmpty());
    }
}

TEST(MeasureView, DoubtsShortRenderings) {
    ViewFigures view;
    view.render_s = spread_of({0.051, 0.051, 0.051});
    EXPECT_TRUE(doubts_about(view).empty());
    view.render_s = spread_of({0.049, 0.049, 0.049});
    ASSERT_EQ(doubts_about(view).size(), 1U);
    EXPECT_THAT(doubts_about(view).front(), testing::HasSubstr("49 ms"));
}

TEST(MeasureView, DoubtsHitsThatDiffer) {
    ViewFigures view;
    view.kinds[1] = {1000, 500, 500, 0, ReplayMode::single, {}, 0};
    EXPECT_TRUE(doubts_about(view).empty());
    view.kinds[1].bare_hits = 700;
    EXPECT_TRUE(doubts_about(view).empty()) << "backs that the renderer passes";
    view.kinds[1].bare_hits = 400;
    EXPECT_EQ(doubts_about(view).size(), 1U);
    view.kinds[2] = {1000, 500, 700, 200, ReplayMode::single, {}, 0};
    EXPECT_EQ(doubts_about(view).size(), 1U) << "faces that are cut away";
    view.kinds[2].spared = 100;
    EXPECT_EQ(doubts_about(view).size(), 2U);
    view.recording_changed_image = true;
    EXPECT_EQ(doubts_about(view).size(), 3U);
}

}  // namespace
}  // namespace obscura::bench
