// tests/session/motion_layer_test.cpp - motion vectors of animated files, against closed forms.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animated_files.h"
#include "session/asset_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace obscura {
namespace {

using namespace gltf::test;

constexpr int motion_width = 64;
constexpr int motion_height = 32;
constexpr double pixels_per_metre = 16;
constexpr double frames_per_second = 10;

/// A square of 2 m in the XY plane, and an orthographic camera at z = 5, 16 pixels a metre.
AssetBuilder square_asset() {
    AssetBuilder builder;
    const int positions = builder.add_accessor(
        "VEC3", 5126, std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
    const int indices =
        builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, 2, 0, 2, 3});
    builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    builder.add_root({{"mesh", 0}});
    builder.tree["cameras"][0] = {
        {"type", "orthographic"},
        {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0.01}, {"zfar", 100}}}};
    builder.add_root({{"camera", 0}, {"translation", {0, 0, 5}}});
    return builder;
}

/// Moves a node along x by 2 m a second.
void slide(AssetBuilder& builder, int node, float z = 0) {
    add_animation(builder,
                  "Slide",
                  {{node_target(node, "translation"), {0, 2}, "VEC3", {-2, 0, z, 2, 0, z}}});
}

struct MotionView {
    double time_s = 1;
    std::optional<gltf::ShutterTimes> shutter = {};
    std::optional<PixelRect> crop = {};
    CameraRequest camera = {};
};

/// The layers `motion` and `position` of an asset at a time.
struct MotionShot {
    OutputImage image;

    MotionShot(const AssetBuilder& builder, const MotionView& view) {
        const TempFolder folder;
        const auto file = folder.write("scene.gltf", builder.finished().dump());
        Log log(Verbosity::quiet);
        RenderRequest request;
        request.options.width = motion_width;
        request.options.height = motion_height;
        request.options.samples_per_pixel = 4;
        request.options.max_bounces = 0;
        request.options.crop = view.crop;
        request.camera = view.camera;
        const std::vector<std::string> names = {"motion", "position"};
        request.options.layers = layers_of(names, 6).value();
        request.load.frame_step_s = 1 / frames_per_second;
        Result<AssetRenderer> renderer = AssetRenderer::open(file, request.load, true, log);
        EXPECT_TRUE(renderer) << renderer.error().message;
        EXPECT_TRUE(renderer->pose({view.time_s, view.shutter, true}, log));
        const Result<ChosenCamera> camera = renderer->prepare(request, {}, log);
        EXPECT_TRUE(camera) << camera.error().message;
        Result<FinishedImage> finished = renderer->render(request, *camera, {}, log);
        EXPECT_TRUE(finished) << finished.error().message;
        image = std::move(finished->image);
    }

    /// X, Y, Z, W at a pixel.
    const float* motion(int x, int y) const {
        return image.layers[0].pixels.data() + 4 * (y * image.width + x);
    }
    const float* position(int x, int y) const {
        return image.layers[1].pixels.data() + 3 * (y * image.width + x);
    }
};

void expect_motion(const float* got, const std::array<double, 4>& expected) {
    for (size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(static_cast<double>(got[c]), expected[c], 2e-4) << "channel " << c;
}

constexpr int mid_x = motion_width / 2 + 3;
constexpr int mid_y = motion_height / 2 + 2;

TEST(MotionLayer, OfASlidingSquareIsItsStepBackAndForward) {
    AssetBuilder builder = square_asset();
    slide(builder, 0);
    const double step = 2 / frames_per_second * pixels_per_metre;
    const MotionShot still(builder, {});
    expect_motion(still.motion(mid_x, mid_y), {-step, 0, step, 0});
    expect_motion(still.motion(1, 1), {0, 0, 0, 0});  // nothing is there
    // An open shutter blurs the square, but not its motion from frame to frame.
    const MotionShot blurred(builder, {.shutter = gltf::ShutterTimes{1, 1.05, 1}});
    expect_motion(blurred.motion(mid_x, mid_y), {-step, 0, step, 0});
    // At the animation's end it stands still from then on.
    const MotionShot last(builder, {.time_s = 2, .shutter = gltf::ShutterTimes{1.9, 1.95, 2}});
    expect_motion(last.motion(motion_width - 2, mid_y), {-step, 0, 0, 0});
}

TEST(MotionLayer, IsTheSameInACrop) {
    AssetBuilder builder = square_asset();
    slide(builder, 0);
    const MotionShot whole(builder, {});
    const MotionShot part(builder, {.crop = PixelRect{20, 10, 11, 7}});
    for (int y = 0; y < 7; ++y) {
        EXPECT_EQ(std::memcmp(part.motion(0, y), whole.motion(20, y + 10), 11 * 16), 0) << y;
    }
}

TEST(MotionLayer, IsExactlyZeroWhereNothingMoves) {
    const MotionShot unmoved(square_asset(), {});
    AssetBuilder beside = square_asset();  // something else moves, and is not seen
    const int other = beside.add_root({{"mesh", 0}});
    slide(beside, other, -50);
    const MotionShot elsewhere(beside, {});
    AssetBuilder held = square_asset();  // it moves, but neither before nor after
    slide(held, 0);
    const MotionShot late(held, {.time_s = 9, .shutter = gltf::ShutterTimes{8.9, 9.1, 9}});
    for (const MotionShot* shot : {&unmoved, &elsewhere, &late}) {
        for (int y = 0; y < motion_height; ++y) {
            for (int c = 0; c < 4 * motion_width; ++c)
                ASSERT_EQ(shot->motion(0, y)[c], 0);
        }
    }
    EXPECT_GT(unmoved.position(mid_x, mid_y)[0], 0);  // the square is there
}

/// In   perspective: 90 degrees high; else orthographic
AssetBuilder sliding_camera(bool perspective) {
    AssetBuilder builder = square_asset();
    if (perspective) {
        builder.tree["cameras"][0] = {
            {"type", "perspective"},
            {"perspective", {{"yfov", std::acos(-1.0) / 2}, {"znear", 0.01}}}};
    }
    slide(builder, 1, 5);
    return builder;
}

TEST(MotionLayer, OfACameraIsTheOppositeOfItsStep) {
    const double moved_m = 2 / frames_per_second;
    const MotionShot parallel(sliding_camera(false), {});
    const double step = moved_m * pixels_per_metre;
    expect_motion(parallel.motion(mid_x, mid_y), {step, 0, -step, 0});
    // At 5 m the image is 10 m high.
    const double smaller = moved_m * motion_height / 10;
    const MotionShot pinhole(sliding_camera(true), {});
    expect_motion(pinhole.motion(motion_width / 2, mid_y), {smaller, 0, -smaller, 0});
    const MotionShot blurred(sliding_camera(true), {.shutter = gltf::ShutterTimes{0.95, 1.05, 1}});
    expect_motion(blurred.motion(motion_width / 2, mid_y), {smaller, 0, -smaller, 0});
    MotionView by_hand;
    by_hand.camera.eye_m = Vec3d{0, 0, 5};
    by_hand.camera.target_m = Vec3d{0, 0, 0};
    const MotionShot placed(sliding_camera(true), by_hand);
    expect_motion(placed.motion(motion_width / 2, mid_y), {0, 0, 0, 0});
}

TEST(MotionLayer, OfAZoomMagnifiesAboutTheCentre) {
    AssetBuilder builder = square_asset();
    builder.tree["extensionsUsed"] = {"KHR_animation_pointer"};
    builder.tree["cameras"][0] = {{"type", "perspective"},
                                  {"perspective", {{"yfov", 0.5}, {"znear", 0.01}}}};
    add_animation(
        builder,
        "Zoom",
        {{pointer_target("/cameras/0/perspective/yfov"), {0, 2}, "SCALAR", {0.5F, 0.3F}}});
    const MotionShot shot(builder, {});
    const auto tan_half = [](double time_s) { return std::tan((0.5 - 0.1 * time_s) / 2); };
    const float* p = shot.position(mid_x, mid_y);
    const auto seen = [&](double time_s, int axis) {
        const double sign = axis == 0 ? 1 : -1;
        return sign * static_cast<double>(p[axis]) / 5 / tan_half(time_s) * motion_height / 2;
    };
    expect_motion(shot.motion(mid_x, mid_y),
                  {seen(0.9, 0) - seen(1, 0),
                   seen(0.9, 1) - seen(1, 1),
                   seen(1.1, 0) - seen(1, 0),
                   seen(1.1, 1) - seen(1, 1)});
}

TEST(MotionLayer, OfARotationIsNotTheSameBackAndForward) {
    AssetBuilder builder = square_asset();
    const auto half = static_cast<float>(std::sqrt(0.5));
    add_animation(  // a quarter turn about z in 2 s
        builder,
        "Turn",
        {{node_target(0, "rotation"), {0, 2}, "VEC4", {0, 0, 0, 1, 0, 0, half, half}}});
    const MotionShot shot(builder, {});
    const float* p = shot.position(mid_x, mid_y);
    std::array<double, 4> expected{};
    for (const size_t forward : {0U, 1U}) {
        const double angle = (forward == 1 ? 1 : -1) * std::acos(-1.0) / 4 / frames_per_second;
        const double x = static_cast<double>(p[0]);
        const double y = static_cast<double>(p[1]);
        expected[2 * forward] = (x * std::cos(angle) - y * std::sin(angle) - x) * pixels_per_metre;
        expected[2 * forward + 1] =
            -(x * std::sin(angle) + y * std::cos(angle) - y) * pixels_per_metre;
    }
    expect_motion(shot.motion(mid_x, mid_y), expected);
    EXPECT_GT(std::abs(expected[0] + expected[2]), 1e-3);
}

TEST(MotionLayer, OfMorphTargetsIsThatOfTheirVertices) {
    AssetBuilder builder = square_asset();  // its right side rises by 1 m in 2 s
    const int target =
        builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0});
    builder.tree["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
    add_animation(builder, "Bend", {{node_target(0, "weights"), {0, 2}, "SCALAR", {0, 1}}});
    for (const auto& shutter :
         {std::optional<gltf::ShutterTimes>(), std::optional(gltf::ShutterTimes{0.99, 1.01, 1})}) {
        const MotionShot shot(builder, {.shutter = shutter});
        const double along = (static_cast<double>(shot.position(mid_x, mid_y)[0]) + 1) / 2;
        const double step = along * 0.5 / frames_per_second * pixels_per_metre;
        expect_motion(shot.motion(mid_x, mid_y), {0, step, 0, -step});
    }
}

TEST(MotionLayer, OfASkinIsThatOfItsJoints) {
    AssetBuilder builder = square_asset();  // all on one joint, which slides
    const int joints = builder.add_accessor("VEC4", 5121, std::vector<uint8_t>(16, 0));
    std::vector<float> weights(16, 0.0F);
    for (size_t v = 0; v < 4; ++v)
        weights[4 * v] = 1;
    const int weight = builder.add_accessor("VEC4", 5126, weights);
    auto& attributes = builder.tree["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints;
    attributes["WEIGHTS_0"] = weight;
    const int joint = builder.add_root({{"name", "joint"}});
    builder.tree["nodes"][0]["skin"] = 0;
    builder.tree["skins"][0] = {{"joints", {joint}}};
    slide(builder, joint);
    const double step = 2 / frames_per_second * pixels_per_metre;
    const MotionShot shot(builder, {});
    expect_motion(shot.motion(mid_x, mid_y), {-step, 0, step, 0});
}

TEST(MotionLayer, OfAPanoramaGoesTheShorterWayRound) {
    AssetBuilder builder = square_asset();
    // Around the seam of the image, behind the camera: 2 m a second at a distance of 5 m.
    builder.tree["nodes"][0]["translation"] = {0, 0, 10};
    builder.tree["nodes"][0]["rotation"] = {0, 1, 0, 0};  // its front side towards the camera
    slide(builder, 0, 10);
    MotionView view;
    view.camera.settings.model = CameraModel::environment;
    view.camera.model = CameraModel::environment;
    view.camera.settings.align = EnvironmentAlign::view;
    const MotionShot shot(builder, view);
    const double turn = std::atan2(0.2, 5.0) / (2 * std::acos(-1.0)) * motion_width;
    int seen = 0;
    for (const int x : {0, motion_width - 1}) {
        const float* m = shot.motion(x, motion_height / 2);
        if (m[0] == 0) continue;
        ++seen;
        // To the right in the world is to the left in an image of what lies behind.
        EXPECT_NEAR(m[0], turn, 0.1 * turn) << x;
        EXPECT_NEAR(m[2], -turn, 0.1 * turn) << x;
    }
    EXPECT_EQ(seen, 2);
}

}  // namespace
}  // namespace obscura
