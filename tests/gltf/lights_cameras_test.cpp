// tests/gltf/lights_cameras_test.cpp - transforms of lights and cameras.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/lights_cameras.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::FloatNear;

Loaded load_light(const json& light, const json& transform) {
    AssetBuilder builder = triangle_builder();
    builder.tree["extensions"]["KHR_lights_punctual"]["lights"][0] = light;
    json node = transform;
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.add_root(node);
    return load_tree(builder.finished());
}

PunctualLight light_of(const json& light, const json& transform = json::object()) {
    const Loaded loaded = load_light(light, transform);
    EXPECT_TRUE(loaded.scene && loaded.scene->lights.size() == 1) << loaded.text();
    return loaded.scene && !loaded.scene->lights.empty() ? loaded.scene->lights[0]
                                                         : PunctualLight{};
}

TEST(Lights, PointInTheWorld) {
    const PunctualLight light =
        light_of({{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 40}, {"range", 7}},
                 {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}});
    EXPECT_EQ(light.type, static_cast<int32_t>(PunctualType::point));
    EXPECT_THAT(light.position, ElementsAre(1, 2, 3));
    EXPECT_THAT(light.intensity, ElementsAre(40, 20, 10));
    EXPECT_EQ(light.range, 7);  // scale does not change it
    EXPECT_EQ(light.spot_scale, 0);
    EXPECT_EQ(light.spot_on_axis, 1);
}

TEST(Lights, DirectionalShinesAlongMinusZ) {
    const double half = std::sqrt(0.5);
    // A quarter turn around X takes -Z to +Y.
    const PunctualLight light = light_of({{"type", "directional"}, {"range", 3}},
                                         {{"rotation", {half, 0, 0, half}}, {"scale", {2, 9, 4}}});
    EXPECT_EQ(light.type, static_cast<int32_t>(PunctualType::directional));
    EXPECT_THAT(light.direction,
                ElementsAre(FloatNear(0, 1e-6f), FloatNear(1, 1e-6f), FloatNear(0, 1e-6f)));
    EXPECT_THAT(light.intensity, ElementsAre(1, 1, 1));
    EXPECT_EQ(light.range, 0);
}

/// The extension's attenuation before it is clamped, linear in the cosine.
double cone_of(const PunctualLight& light, double angle_rad) {
    return light.spot_on_axis - light.spot_scale * (1 - std::cos(angle_rad));
}

/// The extension's attenuation: 1 at the inner cone, 0 at the outer one.
TEST(Lights, SpotConesGoFromOneToZero) {
    const PunctualLight light =
        light_of({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}});
    EXPECT_NEAR(cone_of(light, 0.2), 1, 1e-5);
    EXPECT_NEAR(cone_of(light, 0.6), 0, 1e-5);
    const PunctualLight plain = light_of({{"type", "spot"}, {"spot", json::object()}});
    EXPECT_NEAR(cone_of(plain, 0), 1, 1e-5);
    EXPECT_NEAR(cone_of(plain, std::acos(std::sqrt(0.5))), 0, 1e-5);
    for (const double outer : {0.03, 0.005, 0.0005}) {  // a laser pointer's is the last
        const PunctualLight narrow =
            light_of({{"type", "spot"}, {"spot", {{"outerConeAngle", outer}}}});
        EXPECT_NEAR(cone_of(narrow, 0), 1, 1e-5) << outer;
        EXPECT_NEAR(cone_of(narrow, outer / 2), 0.75, 1e-4) << outer;
        EXPECT_NEAR(cone_of(narrow, outer), 0, 1e-5) << outer;
        const PunctualLight rim =
            light_of({{"type", "spot"},
                      {"spot", {{"innerConeAngle", outer * 0.9}, {"outerConeAngle", outer}}}});
        EXPECT_NEAR(cone_of(rim, outer * 0.9), 1, 1e-5) << outer;
        EXPECT_NEAR(cone_of(rim, outer), 0, 1e-5) << outer;
    }
}

TEST(Lights, OddConesStayFinite) {  // F9
    for (const double inner : {0.6, 0.7, 3.0}) {
        const Loaded loaded = load_light(
            {{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", 0.6}}}},
            json::object());
        ASSERT_TRUE(loaded.scene) << loaded.text();
        EXPECT_TRUE(loaded.warns("innerConeAngle"));
        EXPECT_GT(cone_of(loaded.scene->lights[0], 0.6 * 0.999), 1);
        EXPECT_NEAR(cone_of(loaded.scene->lights[0], 0.6), 0, 1e-4);
    }
    const PunctualLight bright = light_of({{"type", "point"}, {"intensity", 1e300}});
    EXPECT_THAT(bright.intensity, ElementsAre(1e20f, 1e20f, 1e20f));
}

TEST(Lights, WithoutADirectionAreLeftOut) {
    const Loaded loaded = load_light({{"type", "directional"}}, {{"scale", {0, 0, 0}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.scene->lights.empty());
    EXPECT_TRUE(loaded.warns("it is left out"));
    EXPECT_EQ(load_light({{"type", "point"}}, {{"scale", {0, 0, 0}}}).scene->lights.size(), 1U);
}

TEST(Lights, OneForEachNodeWithItsName) {
    AssetBuilder builder = triangle_builder();
    builder.tree["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}}, {{"type", "point"}, {"name", "Lamp"}}};
    for (const int light : {1, 0, 1}) {
        json node;
        node["extensions"]["KHR_lights_punctual"]["light"] = light;
        builder.add_root(node);
    }
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->lights.size(), 3U);
    EXPECT_THAT(loaded.scene->info.light_names, ElementsAre("Lamp", "light 0", "Lamp"));
}

TEST(Cameras, ArePlacedWithoutScale) {
    const double half = std::sqrt(0.5);
    AssetBuilder builder = triangle_builder();
    builder.tree["cameras"] = json::parse(R"([
        {"type": "perspective", "name": "Main",
         "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 50, "aspectRatio": 1.5}},
        {"type": "orthographic",
         "orthographic": {"xmag": 3, "ymag": -2, "znear": 0, "zfar": 9}}])");
    builder.add_root({{"camera", 0},
                      {"translation", {1, 2, 3}},
                      {"rotation", {0, half, 0, half}},
                      {"scale", {2, 3, -4}}});
    builder.add_root({{"camera", 1}, {"name", "Plan"}});
    builder.add_root({{"camera", 1}});
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    ASSERT_EQ(loaded.scene->cameras.size(), 3U);
    const SceneCamera& main = loaded.scene->cameras[0];
    EXPECT_EQ(main.name, "Main");
    EXPECT_EQ(main.type, SceneCameraType::perspective);
    EXPECT_EQ(main.yfov_rad, 0.8);
    EXPECT_EQ(main.aspect, 1.5);
    EXPECT_EQ(main.zfar_m, 50);
    EXPECT_NEAR(determinant(main.world_from_camera), 1, 1e-12);
    EXPECT_EQ(main.world_from_camera.m[1][3], 2);
    // A quarter turn around Y takes Z to X; the negative scale turns it back.
    EXPECT_NEAR(main.world_from_camera.m[0][2], -1, 1e-12);
    EXPECT_NEAR(main.world_from_camera.m[1][1], 1, 1e-12);
    const SceneCamera& plan = loaded.scene->cameras[1];
    EXPECT_EQ(plan.name, "Plan");
    EXPECT_EQ(plan.type, SceneCameraType::orthographic);
    EXPECT_EQ(plan.xmag_m, 3);
    EXPECT_EQ(plan.ymag_m, 2);
    EXPECT_EQ(loaded.scene->cameras[2].name, "camera 1");
}

}  // namespace
}  // namespace obscura::gltf
