// tests/gltf/environment_light_test.cpp - EXT_lights_image_based from a file to the environment.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/environment_light.h"

#include "gltf/animated_files.h"
#include "gltf/images.h"
#include "light/environment_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::HasSubstr;

/// An RGBA PNG of one colour.
std::string colored_png(unsigned side, const std::vector<unsigned>& rgba) {
    std::vector<unsigned> row;
    for (unsigned x = 0; x < side; ++x)
        row.insert(row.end(), rgba.begin(), rgba.end());
    const auto bytes = testing_images::PngBuilder(side, side, 8, 6)
                           .finish(std::vector<std::vector<unsigned>>(side, row));
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Faces of red 255 with alphas of 255 / (face + 1), lit by scene 0.
AssetBuilder lit_asset(const json& light) {
    AssetBuilder builder = triangle_builder();
    json faces;
    for (unsigned face = 0; face < 6; ++face) {
        const int view = builder.add_view(colored_png(4, {255, 0, 0, 255 / (face + 1)}));
        builder.tree["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
        faces.push_back(face);
    }
    json stored = light;
    if (!stored.contains("specularImages")) stored["specularImages"] = {faces};
    if (!stored.contains("specularImageSize")) stored["specularImageSize"] = 4;
    builder.tree["extensions"]["EXT_lights_image_based"]["lights"] = {stored};
    builder.tree["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    builder.tree["extensionsRequired"] = {"EXT_lights_image_based"};
    builder.tree["extensionsUsed"] = {"EXT_lights_image_based"};
    return builder;
}

double red_from(const Scene& scene, const Vec3d& direction) {
    const ImageRgb32f& map = *scene.environment;
    const auto table = EnvironmentTable::create({map.width, map.height, map.pixels.data()}, 1, 0);
    return environment_radiance<double>(table->view(), direction).x;
}

/// Radiance of a face by its alpha's code.
double red_of_face(unsigned face) {
    return 255.0 / (255 / (face + 1));
}

TEST(EnvironmentLight, FacesGoToTheirAxes) {
    const Loaded loaded = load_bytes(lit_asset({{"intensity", 3}, {"name", "sky"}}).glb());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(loaded.scene->info.environment, "sky");
    ASSERT_NE(loaded.scene->environment, nullptr);
    const Vec3d axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (unsigned face = 0; face < 6; ++face)
        EXPECT_NEAR(red_from(*loaded.scene, axes[face]), 3 * red_of_face(face), 1e-5) << face;
}

TEST(EnvironmentLight, AnimationsDimAndTurnIt) {
    AssetBuilder builder = lit_asset({{"intensity", 3}});
    const std::string light = "/extensions/EXT_lights_image_based/lights/0/";
    const float half = std::sqrt(0.5F);
    add_animation(builder,
                  "Dusk",
                  {{pointer_target((light + "intensity").c_str()), {0, 2}, "SCALAR", {0, 4}},
                   {pointer_target((light + "rotation").c_str()),
                    {0, 1},
                    "VEC4",
                    {0, 0, 0, 1, 0, half, 0, half}}});
    const Loaded loaded = load_at(builder.finished(), 1);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    // A quarter turn about +Y brings the face of +X to -Z.
    EXPECT_NEAR(red_from(*loaded.scene, {0, 0, -1}), 2 * red_of_face(0), 1e-5);
    EXPECT_NEAR(red_from(*load_at(builder.finished(), 0.5).scene, {0, 1, 0}), red_of_face(2), 1e-5);
}

TEST(EnvironmentLight, IsTurnedByItsRotation) {
    const double half = std::sqrt(0.5);
    // A quarter turn about X takes +Y to +Z; one about Y takes +Z to +X.
    Loaded loaded = load_bytes(lit_asset({{"rotation", {half, 0, 0, half}}}).glb());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_NEAR(red_from(*loaded.scene, {0, 0, 1}), red_of_face(2), 1e-5);
    EXPECT_NEAR(red_from(*loaded.scene, {1, 0, 0}), red_of_face(0), 1e-5);
    loaded = load_bytes(lit_asset({{"rotation", {0, half, 0, half}}}).glb());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_NEAR(red_from(*loaded.scene, {1, 0, 0}), red_of_face(4), 1e-5);
}

TEST(EnvironmentLight, OnlyTheSceneThatNamesItIsLit) {
    AssetBuilder builder = lit_asset(json::object());
    builder.tree["scenes"][1] = {{"nodes", {0}}};
    LoadOptions options;
    options.scene = 1;
    const Loaded other = load_bytes(builder.glb(), "scene.glb", options);
    ASSERT_TRUE(other.scene) << other.text();
    EXPECT_EQ(other.scene->environment, nullptr);
    EXPECT_EQ(other.scene->info.environment, "");
    options.scene = 0;
    options.info_only = true;
    const Loaded info = load_bytes(builder.glb(), "scene.glb", options);
    ASSERT_TRUE(info.scene) << info.text();
    EXPECT_EQ(info.scene->environment, nullptr);
    EXPECT_EQ(info.scene->info.environment, "image-based light 0");
}

TEST(EnvironmentLight, FaultsHaveAPlace) {
    const auto fault = [](const json& light) {
        const Loaded loaded = load_bytes(lit_asset(light).glb(), "scene.glb");
        return std::to_string(loaded.code()) + " " + loaded.id() + " " + loaded.text();
    };
    EXPECT_THAT(fault({{"specularImages", json::array()}}), HasSubstr("65 E-LIGHT-FACES"));
    EXPECT_THAT(fault({{"specularImages", {{0, 1, 2}}}}), HasSubstr("65 E-LIGHT-FACES"));
    const std::string index = fault({{"specularImages", {{0, 1, 2, 3, 4, 6}}}});
    EXPECT_THAT(index, HasSubstr("65 E-DOC-INDEX"));
    EXPECT_THAT(index, HasSubstr("/extensions/EXT_lights_image_based/lights/0/specularImages/0"));
    EXPECT_THAT(fault({{"specularImages", 3}}), HasSubstr("65 E-JSON-TYPE"));
    EXPECT_THAT(fault({{"rotation", {0, 0, 0, 0}}}), HasSubstr("65 E-LIGHT-ROTATION"));

    AssetBuilder builder = lit_asset(json::object());
    builder.tree["images"][2]["bufferView"] = builder.add_view(colored_png(8, {9, 9, 9, 255}));
    Loaded loaded = load_bytes(builder.glb(), "scene.glb");
    EXPECT_EQ(loaded.id(), "E-ENV-FACES");
    EXPECT_THAT(loaded.text(), HasSubstr("a face is 8 x 8, the first one is 4 wide"));
    builder.tree["images"][2]["bufferView"] = builder.add_view("no picture");
    loaded = load_bytes(builder.glb(), "scene.glb");
    EXPECT_EQ(loaded.id(), "E-IMG-FORMAT");
    builder = lit_asset(json::object());
    builder.tree["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
    EXPECT_EQ(load_bytes(builder.glb(), "scene.glb").id(), "E-DOC-INDEX");
    loaded = load_bytes(lit_asset({{"specularImageSize", 256}}).glb());
    EXPECT_TRUE(loaded.scene &&
                loaded.warns("specularImageSize is 256, but the images are 4 wide"));
}

}  // namespace
}  // namespace obscura::gltf
