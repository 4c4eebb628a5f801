// tests/session/asset_renderer_test.cpp - from a file to an image: the camera is chosen once.
// SPDX-License-Identifier: Apache-2.0
#include "session/asset_renderer.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace obscura {
namespace {

const std::filesystem::path cornell = OBSCURA_SOURCE_DIR "/assets/cornell/cornell.gltf";

RenderRequest small_request() {
    RenderRequest request;
    request.options.width = 32;
    request.options.height = 24;
    request.options.samples_per_pixel = 1;
    return request;
}

TEST(AssetRenderer, TheCameraIsChosenOnceThoughItIsFocused) {
    int chosen = 0;
    int focused = 0;
    const LogSink count = [&](const LogMessage& message) {
        chosen += message.text.starts_with("camera: ") ? 1 : 0;
        focused += message.text.starts_with("focus: ") ? 1 : 0;
    };
    Log log(Verbosity::verbose, count);
    Result<AssetRenderer> renderer = AssetRenderer::open(cornell, {}, false, log);
    ASSERT_TRUE(renderer);
    ASSERT_TRUE(renderer->pose({}, log));
    RenderRequest request = small_request();
    request.camera.settings.fstop = 2;
    request.camera.settings.focal_length_m = 0.05;
    request.camera.settings.sensor_m = {0.036, 0.024};
    request.camera.settings.model = CameraModel::thin_lens;
    request.camera.focus_on_px = {16, 12};
    const std::vector<std::string> layers = {"normal", "depth"};  // the focus ray has none
    ASSERT_TRUE(choose_layers(layers, request));
    const Result<ChosenCamera> camera = renderer->prepare(request, {}, log);
    ASSERT_TRUE(camera) << camera.error().message;
    EXPECT_EQ(chosen, 1);
    EXPECT_EQ(focused, 1);
    request.options.layers.clear();

    // The focus distance is that of the pixel's hit.
    RenderRequest depth = request;
    depth.options.integrator = Integrator::depth;
    const Result<FinishedImage> image = renderer->render(depth, *camera, {}, log);
    ASSERT_TRUE(image);
    const float seen = image->image.pixels[12 * 32 + 16];
    EXPECT_NEAR(1 / camera->camera.thin_lens.inverse_focus, seen, 1e-4F * seen);
}

TEST(AssetRenderer, ACameraThatThereIsNotLeavesThePose) {
    Log log;
    Result<AssetRenderer> renderer = AssetRenderer::open(cornell, {}, false, log);
    ASSERT_TRUE(renderer);
    ASSERT_TRUE(renderer->pose({}, log));
    RenderRequest request = small_request();
    request.camera.choice = "none";
    const Result<ChosenCamera> camera = renderer->prepare(request, {}, log);
    ASSERT_FALSE(camera);
    EXPECT_EQ(camera.error().id, "E-CAM-UNKNOWN");
    EXPECT_EQ(camera.error().where, setting("camera"));
    EXPECT_TRUE(renderer->has_scene());
    EXPECT_TRUE(renderer->prepare(small_request(), {}, log));
}

TEST(AssetRenderer, ViewsOfOnePoseShareWhatFramesThem) {
    Log log;
    RenderRequest request = small_request();
    request.camera.frames = true;
    request.camera.framing.azimuth_rad = 1;
    const auto place = [](const Result<ChosenCamera>& camera) {
        const auto& m = camera.value().camera.world_from_camera.m;
        return std::array{m[0][3], m[1][3], m[2][3]};
    };
    const auto opened = [&] {
        AssetRenderer renderer = AssetRenderer::open(cornell, {}, false, log).value();
        EXPECT_TRUE(renderer.plan_variants({""}, true));
        return renderer;
    };
    AssetRenderer renderer = opened();
    ASSERT_TRUE(renderer.pose({}, log));
    const auto first = place(renderer.prepare(request, {}, log));
    EXPECT_EQ(place(renderer.look_again(request, log)), first);
    renderer.prepare_again();
    EXPECT_EQ(place(renderer.prepare(request, {}, log)), first) << "for another light";
    // Another pose is framed anew.
    const std::vector<double> aside = {20, 0, 0};
    ASSERT_TRUE(renderer.set_value("/nodes/0/translation", aside));
    ASSERT_TRUE(renderer.pose({}, log));
    const auto moved = place(renderer.prepare(request, {}, log));
    EXPECT_NE(moved, first);
    AssetRenderer other = opened();
    ASSERT_TRUE(other.set_value("/nodes/0/translation", aside));
    ASSERT_TRUE(other.pose({}, log));
    EXPECT_EQ(place(other.prepare(request, {}, log)), moved);
}

}  // namespace
}  // namespace obscura
