// tests/gltf/light_profiles_test.cpp - EXT_lights_ies from a file to lights of the scene.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/light_profiles.h"

#include "gltf/gltf_files.h"
#include "light/punctual_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;

/// Type C: 100 cd straight ahead, at 90 degrees 10 cd towards horizontal angle 0, 40 cd towards 90.
constexpr const char* type_c =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 3 1 2 0 0 0\n1 1 10\n"
    "0 90\n0 90 180\n100 10\n100 40\n100 20\n";
/// Type B: 100 cd ahead, 30 cd at a horizontal angle of 90, 7 cd at a vertical angle of 90.
constexpr const char* type_b =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 2 2 0 0 0\n1 1 10\n"
    "-90 0 90\n-90 0 90\n3 20 7\n3 100 7\n3 30 7\n";

json profile_asset(const json& light, const json& node) {
    AssetBuilder builder = triangle_builder();
    builder.tree["extensions"]["EXT_lights_ies"]["lights"][0] = light;
    builder.tree["extensionsRequired"] = {"EXT_lights_ies"};
    builder.tree["extensionsUsed"] = {"EXT_lights_ies"};
    json placed = node;
    placed["extensions"]["EXT_lights_ies"]["light"] = 0;
    builder.add_root(placed);
    return builder.finished();
}

json uri_light(const char* text) {
    return {{"name", "lamp"}, {"uri", "data:application/x-ies-lm-63;base64," + base64(text)}};
}

/// Candela into a direction, at the light's own place.
double candela(const Scene& scene, const Vec3d& direction) {
    const LightProfileTable table = pack_light_profiles(scene.light_profiles);
    const PunctualLight& light = scene.lights.at(0);
    const Vec3d at{light.position[0], light.position[1], light.position[2]};
    return sample_punctual<double>(scene.lights.data(), 0, at + direction, table.view())
        .irradiance.x;
}

TEST(LightProfiles, TypeCIsAimedAtMinusZ) {
    const Loaded loaded = load_tree(profile_asset(uri_light(type_c), {{"translation", {1, 2, 3}}}));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    ASSERT_EQ(loaded.scene->lights.size(), 1U);
    EXPECT_THAT(loaded.scene->info.light_names, ElementsAre("lamp"));
    EXPECT_THAT(loaded.scene->lights[0].position, ElementsAre(1, 2, 3));
    EXPECT_NEAR(candela(*loaded.scene, {0, 0, -1}), 100, 1e-9);
    EXPECT_NEAR(candela(*loaded.scene, {1, 0, 0}), 10, 1e-9);
    EXPECT_NEAR(candela(*loaded.scene, {0, 1, 0}), 40, 1e-9);  // counter-clockwise seen from +Z
    EXPECT_NEAR(candela(*loaded.scene, {-1, 0, 0}), 20, 1e-9);
    EXPECT_NEAR(candela(*loaded.scene, {0, -1, 0}), 40, 1e-9);
    EXPECT_EQ(candela(*loaded.scene, {0, 0.1, 0.99}), 0);
}

TEST(LightProfiles, TypeBTurnsAboutX) {
    const Loaded loaded = load_tree(profile_asset(uri_light(type_b), json::object()));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_NEAR(candela(*loaded.scene, {0, 0, -1}), 100, 1e-9);
    EXPECT_NEAR(candela(*loaded.scene, {0, -1, 0}), 30, 1e-9);  // clockwise
    EXPECT_NEAR(candela(*loaded.scene, {0, 1, 0}), 20, 1e-9);
    EXPECT_NEAR(candela(*loaded.scene, {1, 0, 0}), 7, 1e-9);
    EXPECT_NEAR(candela(*loaded.scene, {-1, 0, 0}), 3, 1e-9);
    EXPECT_EQ(candela(*loaded.scene, {0, 0, 1}), 0);
}

TEST(LightProfiles, NodesTurnAndColourThem) {
    const double half = std::sqrt(0.5);
    json node = {{"rotation", {-half, 0, 0, half}}, {"scale", {3, 3, 3}}};  // -Z becomes -Y
    node["extensions"]["EXT_lights_ies"] = {{"multiplier", 2}, {"color", {1, 0.5, 0}}};
    const Loaded loaded = load_tree(profile_asset(uri_light(type_c), node));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_THAT(loaded.scene->lights[0].intensity, ElementsAre(2, 1, 0));
    EXPECT_NEAR(candela(*loaded.scene, {0, -1, 0}), 200, 1e-4);
    EXPECT_NEAR(candela(*loaded.scene, {1, 0, 0}), 20, 1e-4);
}

TEST(LightProfiles, FromABufferViewAndAFile) {
    AssetBuilder builder = triangle_builder();
    const int view = builder.add_view(type_c);
    builder.tree["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"bufferView", view}, {"mimeType", "application/x-ies-lm-63"}}, {{"uri", "lamp.ies"}}};
    for (const int light : {0, 1})
        builder.add_root({{"extensions", {{"EXT_lights_ies", {{"light", light}}}}}});
    const TempFolder folder;
    folder.write("lamp.ies", type_b);
    const Loaded loaded = load_file(folder.write("scene.glb", builder.glb()));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    ASSERT_EQ(loaded.scene->lights.size(), 2U);
    EXPECT_EQ(loaded.scene->lights[1].profile, 1);
    EXPECT_NEAR(candela(*loaded.scene, {0, 0, -1}), 100, 1e-9);
}

TEST(LightProfiles, TooManyNumbersAreRefused) {
    Document document;
    document.profiles.resize(2);
    for (GltfLightProfile& profile : document.profiles)
        profile.uri = "data:application/x-ies-lm-63;base64," + base64(type_c);
    document.nodes.resize(2);
    document.nodes[0].ies.profile = 0;
    document.nodes[1].ies.profile = 1;
    const Result<std::vector<LightProfile>> all = load_light_profiles(document, {}, "");
    ASSERT_TRUE(all) << all.error().message;
    const size_t numbers = 2 * (all->at(0).candela.size() + all->at(0).polar_deg.size());
    EXPECT_TRUE(load_light_profiles(document, {}, "", numbers));
    const Result<std::vector<LightProfile>> fewer =
        load_light_profiles(document, {}, "", numbers - 1);
    ASSERT_FALSE(fewer);
    EXPECT_EQ(fewer.error().id, "E-LIMIT-PROFILES");
    EXPECT_EQ(fewer.error().code, ExitCode::refused);
    EXPECT_THAT(fewer.error().where, HasSubstr("/extensions/EXT_lights_ies/lights/1"));
}

TEST(LightProfiles, FaultsHaveAPlace) {
    const auto fault = [](const json& light, const json& node = json::object()) {
        const Loaded loaded = load_tree(profile_asset(light, node));
        return std::to_string(loaded.code()) + " " + loaded.id() + " " + loaded.text();
    };
    EXPECT_THAT(fault(json::object()), HasSubstr("65 E-LIGHT-PROFILE"));
    EXPECT_THAT(fault({{"uri", "a"}, {"bufferView", 0}}), HasSubstr("65 E-LIGHT-PROFILE"));
    EXPECT_THAT(fault({{"bufferView", 99}}), HasSubstr("65 E-DOC-INDEX"));
    EXPECT_THAT(fault({{"uri", "lamp.ies"}}), HasSubstr("67 E-RES-MISSING"));
    EXPECT_THAT(fault({{"uri", "../lamp.ies"}}), HasSubstr("77 E-URI-REFUSED"));
    EXPECT_THAT(fault(uri_light("TILT=NONE\n1 1 one")),
                HasSubstr("scene.gltf#/extensions/EXT_lights_ies/lights/0: line 2: \"one\""));
    EXPECT_THAT(fault(uri_light("TILT=NONE\n1 1 one")), HasSubstr("65 E-IES-NUMBER"));
    json node;
    node["extensions"]["EXT_lights_ies"]["multiplier"] = -1;
    const Loaded clamped = load_tree(profile_asset(uri_light(type_c), node));
    ASSERT_TRUE(clamped.scene);
    EXPECT_TRUE(clamped.warns("/nodes/1/extensions/EXT_lights_ies/multiplier"));
}

}  // namespace
}  // namespace obscura::gltf
