// tests/gltf/z_up_test.cpp - files whose up is +Z, against glTF, stand upright.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/load.h"

#include <gtest/gtest.h>

#include "support/small_scenes.h"
#include "support/temp_folder.h"

namespace obscura::gltf {
namespace {

Scene load(const TempFolder& folder, bool z_up) {
    Log log(Verbosity::quiet);
    LoadOptions options;
    options.z_up = z_up;
    Result<Scene> scene = load_gltf(folder / "quad.gltf", options, log);
    EXPECT_TRUE(scene) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
}

TEST(ZUp, TurnsMeshesCamerasAndLightsAlike) {
    const TempFolder folder;
    folder.write("quad.gltf", gltf_text(lit_quad_scene()));
    const Scene as_is = load(folder, false);
    const Scene turned = load(folder, true);
    ASSERT_EQ(as_is.positions.size(), turned.positions.size());
    ASSERT_GE(as_is.positions.size(), 12U);
    for (size_t i = 0; i < 12; i += 3) {
        EXPECT_EQ(turned.positions[i], as_is.positions[i]);
        EXPECT_EQ(turned.positions[i + 1], as_is.positions[i + 2]);
        EXPECT_EQ(turned.positions[i + 2], -as_is.positions[i + 1]);
    }
    const auto& camera = turned.cameras.at(0).world_from_camera.m;  // at (0, 0, 3), along -Z
    EXPECT_EQ(camera[1][3], 3);
    EXPECT_EQ(camera[2][3], 0);
    EXPECT_EQ(camera[1][2], 1);   // it looks down
    EXPECT_EQ(camera[2][1], -1);  // its up is the file's +Y
    ASSERT_EQ(turned.lights.size(), as_is.lights.size());
}

}  // namespace
}  // namespace obscura::gltf
