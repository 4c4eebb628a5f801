// tests/dataset/ray_labels_test.cpp - silhouettes, what is seen of them, and depths.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dataset/image_labels.h"
#include "support/scene_builder.h"
#include <algorithm>

namespace obscura::dataset {
namespace {

/// A square of 2 m at the origin, node 0, and before its right half another one, node 1; both face
/// +Z. The camera is 10 m away.
class TwoSquares : public testing::Test {
protected:
    static constexpr int size = 64;

    TwoSquares() {
        test::SceneBuilder builder;
        far_material_ = builder.material({});
        near_material_ = builder.material({});
        builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, far_material_);
        builder.quad({0, -1, 1}, {1, 0, 0}, {0, 2, 0}, near_material_);
        Scene scene = builder.take();
        scene.node_places.resize(2);
        Log log(Verbosity::quiet);
        prepared_.emplace(PreparedScene::create(std::move(scene), {}, Isa::automatic, log).value());
        options_.width = options_.height = size;
    }

    /// In   half_width_m: of what the image shows at the origin
    RayLabels trace(double half_width_m, const Vec3f& target = {0, 0, 0}) const {
        const double angle = 2 * std::atan(half_width_m / 10);
        const Vec3f eye = target + Vec3f{0, 0, 10};
        const Camera camera = test::look_at(eye, target, static_cast<float>(angle), size, size);
        return trace_labels(*prepared_, camera, options_);
    }

    /// Pixels whose middles lie between two places on the image's axis, in metres at the origin.
    static int pixels_between(double low, double high, double half_width_m) {
        int count = 0;
        for (int i = 0; i < size; ++i) {
            const double place = ((i + 0.5) / size * 2 - 1) * half_width_m;
            count += place > low && place < high ? 1 : 0;
        }
        return count;
    }

    int32_t far_material_ = 0, near_material_ = 0;
    std::optional<PreparedScene> prepared_;
    RenderOptions options_;
};

TEST_F(TwoSquares, EveryPixelHasTheMaterialOfItsNode) {
    const RayLabels rays = trace(1.51);
    ASSERT_NE(far_material_, near_material_);
    for (size_t i = 0; i < rays.node.size(); ++i) {
        const std::array<int32_t, 3> materials = {-1, far_material_, near_material_};
        ASSERT_EQ(rays.material[i], materials[static_cast<size_t>(rays.node[i] + 1)]) << i;
    }
}

TEST_F(TwoSquares, WhatIsHiddenCountsToo) {
    const double half = 1.51;
    const RayLabels rays = trace(half);
    EXPECT_EQ(rays.frame.width, size);  // all is in the image
    const std::vector<ObjectLabel> objects = label_objects(rays, prepared_->scene());
    ASSERT_EQ(objects.size(), 2U);
    const auto across = static_cast<size_t>(pixels_between(-1, 1, half));
    EXPECT_EQ(objects[0].pixels, across * across);
    // The near square is 9 m away, and so larger by 10 / 9.
    const double edge = 10.0 / 9;
    const auto near_columns = static_cast<size_t>(pixels_between(0, edge, half));
    const auto near_rows = static_cast<size_t>(pixels_between(-edge, edge, half));
    EXPECT_EQ(objects[1].pixels, near_columns * near_rows);
    EXPECT_EQ(objects[1].visible_pixels, objects[1].pixels);
    const auto seen_columns = static_cast<size_t>(pixels_between(-1, 0, half));
    EXPECT_EQ(objects[0].visible_pixels, seen_columns * across);
    EXPECT_EQ(objects[0].visible_box->width, static_cast<int>(seen_columns));
    EXPECT_EQ(objects[0].box->width, static_cast<int>(across));
    EXPECT_NEAR(objects[0].visibility(), 0.5, 0.02);
}

TEST_F(TwoSquares, DepthsAreAlongTheAxis) {
    const RayLabels rays = trace(1.51);
    const auto at = [&](int x, int y) { return static_cast<size_t>(y * size + x); };
    EXPECT_EQ(rays.node[at(0, 0)], -1);
    EXPECT_EQ(rays.depth_m[at(0, 0)], 0);
    EXPECT_EQ(rays.node[at(14, 14)], 0);
    EXPECT_NEAR(rays.depth_m[at(14, 14)], 10, 1e-5);
    EXPECT_EQ(rays.node[at(45, 14)], 1);
    EXPECT_NEAR(rays.depth_m[at(45, 14)], 9, 1e-5);
}

TEST_F(TwoSquares, WhatLeavesTheImageCountsInThePixelsOfAll) {
    const double half = 0.75;
    const RayLabels rays = trace(half, {1, 0, 0});  // from x = 0.25 to 1.75
    EXPECT_EQ(rays.frame.width, 3 * size);
    const std::vector<ObjectLabel> objects = label_objects(rays, prepared_->scene());
    ASSERT_EQ(objects.size(), 2U);
    const double pixels_per_m = size / (2 * half);
    EXPECT_NEAR(static_cast<double>(objects[0].pixels), 4 * pixels_per_m * pixels_per_m, 2 * size);
    EXPECT_EQ(objects[0].pixels_inside, static_cast<size_t>(pixels_between(-0.75, 0, half) * size));
    EXPECT_LT(objects[0].box->left, 0);
    EXPECT_LT(objects[0].box->top, 0);
    EXPECT_GT(objects[0].box->height, size);
    EXPECT_EQ(objects[0].visible_pixels, 0U);
    EXPECT_FALSE(objects[0].visible_box);
}

TEST_F(TwoSquares, SilhouettesOfSmallAndOddImagesAscend) {
    for (const auto& [columns, rows] : {std::pair{1, 1}, {3, 7}, {6, 1}, {33, 30}}) {
        options_.width = columns;
        options_.height = rows;
        const Camera camera = test::look_at({0, 0, 10}, {0, 0, 0}, 0.15f, columns, rows);
        const RayLabels rays = trace_labels(*prepared_, camera, options_);
        std::vector<std::vector<uint32_t>> pixels(2);
        for (const Silhouette& silhouette : rays.silhouettes) {
            EXPECT_TRUE(std::is_sorted(silhouette.pixels.begin(), silhouette.pixels.end()));
            pixels[static_cast<size_t>(silhouette.node)] = silhouette.pixels;
        }
        EXPECT_FALSE(pixels[0].empty());
        for (size_t node = 0; node < 2; ++node) {
            for (const uint32_t pixel : pixels[node]) {  // nothing lies before the near square
                if (!rays.is_inside(pixel)) continue;
                EXPECT_GE(rays.node[rays.image_index(pixel)], static_cast<int32_t>(node));
            }
        }
    }
}

TEST_F(TwoSquares, MasksAreOfTheImage) {
    const RayLabels rays = trace(0.75, {1, 0, 0});
    for (const ObjectLabel& object : label_objects(rays, prepared_->scene())) {
        const Masks masks = masks_of(rays, object);
        EXPECT_EQ(masks.all.size(), object.pixels_inside);
        EXPECT_EQ(masks.visible.size(), object.visible_pixels);
        for (const uint32_t pixel : masks.visible)
            EXPECT_EQ(rays.node[pixel], object.node);
        EXPECT_TRUE(std::includes(
            masks.all.begin(), masks.all.end(), masks.visible.begin(), masks.visible.end()));
    }
}

TEST_F(TwoSquares, AHoldoutHidesAndIsNoObject) {
    Scene scene = prepared_->take_scene();
    scene.visibility.primitives = {0, visibility_holdout};
    Log log(Verbosity::quiet);
    ASSERT_TRUE(prepared_->update(std::move(scene), {}, log));
    const std::vector<Silhouette> found = trace(1.51).silhouettes;
    ASSERT_EQ(found.size(), 1U);
    const RayLabels rays = trace(1.51);
    const std::vector<ObjectLabel> objects = label_objects(rays, prepared_->scene());
    EXPECT_EQ(objects[0].node, 0);
    EXPECT_NEAR(objects[0].visibility(), 0.5, 0.02);
    const size_t held_out = 14 * size + 45;
    EXPECT_EQ(rays.node[held_out], -1);
    EXPECT_EQ(rays.depth_m[held_out], 0);
}

TEST_F(TwoSquares, FarFromTheOriginLayersStayApart) {
    const Vec3f far{3e5f, 0, 0};
    test::SceneBuilder builder;
    const int32_t material = builder.material({});
    builder.quad(far + Vec3f{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material);
    builder.quad(far + Vec3f{-1, -1, 0.5f}, {2, 0, 0}, {0, 2, 0}, material);
    Scene scene = builder.take();
    scene.node_places.resize(2);
    Log log(Verbosity::quiet);
    prepared_.emplace(PreparedScene::create(std::move(scene), {}, Isa::automatic, log).value());
    const RayLabels rays = trace(1.5, far);
    ASSERT_EQ(rays.silhouettes.size(), 2U);
    EXPECT_NEAR(static_cast<double>(rays.silhouettes[0].pixels.size()),
                static_cast<double>(rays.silhouettes[1].pixels.size()),
                4.0 * size);
}

TEST_F(TwoSquares, RaysThatGrazeAFaceGetBehindIt) {
    test::SceneBuilder builder;
    const int32_t material = builder.material({});
    const Vec3f corner{30, 20, -30};
    builder.quad(corner + Vec3f{0, 0.3f, 20}, {20, 0, 0}, {0, 0, -20}, material);
    builder.quad(corner + Vec3f{-50, 0, 40}, {120, 0, 0}, {0, 0, -200}, material);
    Scene scene = builder.take();
    scene.node_places.resize(2);
    Log log(Verbosity::quiet);
    prepared_.emplace(PreparedScene::create(std::move(scene), {}, Isa::automatic, log).value());
    const Vec3f eye = corner + Vec3f{10, 1.0f, 21};
    const Camera camera = test::look_at(eye, eye + Vec3f{0, -0.05f, -1}, 0.3f, size, size);
    const RayLabels rays = trace_labels(*prepared_, camera, options_);
    ASSERT_EQ(rays.silhouettes.size(), 2U);
    size_t crossing = 0;
    for (const uint32_t pixel : rays.silhouettes[0].pixels) {
        const auto& below = rays.silhouettes[1].pixels;
        crossing += std::binary_search(below.begin(), below.end(), pixel) ? 1U : 0U;
    }
    EXPECT_GT(rays.silhouettes[0].pixels.size(), 1000U);
    EXPECT_EQ(crossing, rays.silhouettes[0].pixels.size());
}

TEST_F(TwoSquares, BackFacesAreNotThere) {
    Camera behind = test::look_at({0, 0, -10}, {0, 0, 0}, 0.4f, size, size);
    EXPECT_TRUE(trace_labels(*prepared_, behind, options_).silhouettes.empty());
}

}  // namespace
}  // namespace obscura::dataset
