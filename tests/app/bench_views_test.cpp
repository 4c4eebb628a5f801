// tests/app/bench_views_test.cpp - the whole, the close and the own view of the bench.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_views.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::app {
namespace {

using test::SceneBuilder;

/// Six two-sided squares around the origin.
PreparedScene box(const Vec3f& half) {
    SceneBuilder builder;
    Material material;
    material.flags = material_double_sided;
    const int32_t index = builder.material(material);
    const Vec3f edge[3] = {{2 * half.x, 0, 0}, {0, 2 * half.y, 0}, {0, 0, 2 * half.z}};
    for (size_t axis = 0; axis < 3; ++axis) {
        const Vec3f& a = edge[(axis + 1) % 3];
        const Vec3f& b = edge[(axis + 2) % 3];
        builder.quad(half * -1.0f, a, b, index);
        builder.quad(half * -1.0f + edge[axis], a, b, index);
    }
    Log silent(Verbosity::quiet);
    auto prepared = PreparedScene::create(builder.take(), {}, Isa::automatic, silent);
    EXPECT_TRUE(prepared);
    return std::move(*prepared);
}

RenderRequest wide_request() {
    RenderRequest request;
    request.options.width = 320;
    request.options.height = 180;
    return request;
}

std::vector<BenchView> views_of(const PreparedScene& scene,
                                const RenderRequest& request,
                                ViewChoice choice) {
    Log silent(Verbosity::quiet);
    const auto views = choose_bench_views(scene, request, choice, silent);
    EXPECT_TRUE(views);
    return views.value_or(std::vector<BenchView>());
}

TEST(BenchViews, TheCloseViewIsCoveredByTheAsset) {
    for (const Vec3f half : {Vec3f{1, 1, 1}, Vec3f{0.05f, 2, 0.05f}, Vec3f{100, 1, 100}}) {
        const PreparedScene scene = box(half);
        const auto views = views_of(scene, wide_request(), ViewChoice::both);
        ASSERT_EQ(views.size(), 2U);
        EXPECT_EQ(views[0].name, "whole");
        EXPECT_LT(views[0].coverage, close_coverage);
        EXPECT_EQ(views[1].name, "close");
        EXPECT_GE(views[1].coverage, close_coverage);
        EXPECT_LT(views[1].coverage, 0.85) << "the widest such view";
        EXPECT_LT(views[1].numbers.yfov_deg, views[0].numbers.yfov_deg);
        const Result<double> again = measure_coverage(scene, views[1].camera, 320.0 / 180.0);
        ASSERT_TRUE(again);
        EXPECT_EQ(*again, views[1].coverage);
    }
}

TEST(BenchViews, OneAloneWhenAskedFor) {
    const PreparedScene scene = box({1, 1, 1});
    const auto whole = views_of(scene, wide_request(), ViewChoice::whole);
    ASSERT_EQ(whole.size(), 1U);
    EXPECT_EQ(whole[0].name, "whole");
    const auto close = views_of(scene, wide_request(), ViewChoice::close);
    ASSERT_EQ(close.size(), 1U);
    EXPECT_EQ(close[0].name, "close");
}

TEST(BenchViews, AWholeViewThatIsCoveredIsHalved) {
    const PreparedScene scene = box({1, 1, 1});
    RenderRequest request = wide_request();
    request.camera.yfov_rad = 0.1;
    const auto framed = views_of(scene, request, ViewChoice::both);  // framing moves away
    EXPECT_LT(framed[0].coverage, close_coverage);
    request.options.width = 180;  // the automatic view of a cube fills about half of a square
    request.camera.yfov_rad.reset();
    const auto square = views_of(scene, request, ViewChoice::both);
    EXPECT_GT(square[0].coverage, framed[0].coverage);
    EXPECT_GE(square[1].coverage, close_coverage);
}

TEST(BenchViews, ACameraPlacedByHandIsTheOnlyOne) {
    const PreparedScene scene = box({1, 1, 1});
    RenderRequest request = wide_request();
    request.camera.eye_m = Vec3d{0, 0, 5};
    request.camera.target_m = Vec3d{0, 0, 0};
    request.camera.yfov_rad = 0.5;
    const auto views = views_of(scene, request, ViewChoice::both);
    ASSERT_EQ(views.size(), 1U);
    EXPECT_EQ(views[0].name, "own");
    EXPECT_NEAR(views[0].numbers.eye_m.z, 5, 1e-6);
    EXPECT_NEAR(views[0].numbers.target_m.z, 0, 1e-5);
    EXPECT_NEAR(views[0].numbers.up.y, 1, 1e-6);
    EXPECT_NEAR(views[0].numbers.yfov_deg, 0.5 * 180 / pi_d, 1e-4);
}

TEST(BenchViews, NothingToSeeEndsTheSearch) {
    SceneBuilder builder;
    Log silent(Verbosity::quiet);
    auto scene = PreparedScene::create(builder.take(), {}, Isa::automatic, silent);
    ASSERT_TRUE(scene);
    Log log(Verbosity::quiet);
    const auto views = choose_bench_views(*scene, wide_request(), ViewChoice::close, log);
    ASSERT_TRUE(views);
    EXPECT_EQ(views->front().coverage, 0);
    EXPECT_EQ(log.warnings().size(), 1U);
}

}  // namespace
}  // namespace obscura::app
