// tests/render/enclosed_lights_test.cpp - lights inside the closed mesh of their own fixture.
// SPDX-License-Identifier: Apache-2.0
#include "render/enclosed_lights.h"

#include "support/thin_wall_scenes.h"
#include <gmock/gmock.h>
#include <optional>

namespace obscura::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Vec3f outside{0, 1, 6};

PreparedScene prepare(Scene scene) {
    Log log(Verbosity::quiet);
    auto prepared = PreparedScene::create(std::move(scene), {}, Isa::automatic, log);
    if (!prepared) throw std::runtime_error(prepared.error().message);
    return std::move(*prepared);
}

std::vector<int32_t> enclosing_nodes(Scene scene, const Vec3f& eye = outside) {
    std::vector<int32_t> nodes;
    for (const EnclosedLight& found : find_enclosed_lights(prepare(std::move(scene)), eye))
        nodes.push_back(found.node);
    return nodes;
}

struct Fixture {
    Material material = {};
    float radius = 0.5f;
    bool inward = false;
    std::optional<MaterialLayers> layers = {};
};

/// A floor, node 0, and a ball around a lamp at (0, 1, 0), node 1.
Scene lamp_in(const Fixture& fixture) {
    SceneBuilder builder;
    builder.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, builder.material({}));
    Material material = fixture.material;
    if (fixture.layers) material.layers = 0;
    builder.sphere({0, 1, 0}, fixture.radius, 12, builder.material(material), fixture.inward);
    Scene scene = builder.take();
    if (fixture.layers) scene.layers = {*fixture.layers};
    scene.lights = {lamp_at({0, 1, 0})};
    return scene;
}

Material two_sided() {
    Material m;
    m.flags = material_double_sided;
    return m;
}

PunctualLight spot_down(float outer_rad) {
    PunctualLight light = lamp_at({0, 1, 0});
    light.type = static_cast<int32_t>(PunctualType::spot);
    light.direction[1] = -1;
    light.direction[2] = 0;
    light.spot_scale = 1.0f / (1.0f - std::cos(outer_rad));
    light.spot_on_axis = 1;
    return light;
}

TEST(EnclosedLights, OpaqueFixturesEnclose) {
    EXPECT_THAT(enclosing_nodes(lamp_in({})), ElementsAre(1));
    EXPECT_THAT(enclosing_nodes(lamp_in({.material = two_sided(), .inward = true})),
                ElementsAre(1));
}

TEST(EnclosedLights, LampsInTheOpenAreNotEnclosed) {
    Scene scene = lamp_in({});
    scene.lights[0].position[0] = 2;
    EXPECT_THAT(enclosing_nodes(std::move(scene)), IsEmpty());
}

TEST(EnclosedLights, BulbsOfGlassAndHolesLetLightOut) {
    MaterialLayers glass;
    glass.transmission = 1;
    EXPECT_THAT(enclosing_nodes(lamp_in({.layers = glass})), IsEmpty());
    MaterialLayers shade;
    shade.diffuse_transmission = 0.3f;
    EXPECT_THAT(enclosing_nodes(lamp_in({.layers = shade})), IsEmpty());
    Material veil;
    veil.flags = material_alpha_blend;
    veil.base_color[3] = 0.9f;
    EXPECT_THAT(enclosing_nodes(lamp_in({.material = veil})), IsEmpty());
    Material open;
    open.flags = material_alpha_mask;
    open.base_color[3] = 0;
    EXPECT_THAT(enclosing_nodes(lamp_in({.material = open})), IsEmpty());
}

TEST(EnclosedLights, ARoomThatHoldsTheCameraEnclosesNothing) {
    const Fixture room{.material = two_sided(), .radius = 9, .inward = true};
    EXPECT_THAT(enclosing_nodes(lamp_in(room)), IsEmpty());
    // Without a floor in the way all of the lamp's light stays inside the room.
    SceneBuilder builder;
    builder.sphere({0, 1, 0}, 9, 12, builder.material(two_sided()), true);
    Scene bare = builder.take();
    bare.lights = {lamp_at({0, 1, 0})};
    EXPECT_THAT(enclosing_nodes(Scene(bare)), IsEmpty());
    EXPECT_THAT(enclosing_nodes(Scene(bare), {0, 1, 20}), ElementsAre(0));
}

/// Through its single-sided near wall the camera sees the surfaces that the lamp lights.
TEST(EnclosedLights, RoomsSeenFromOutsideEncloseNothing) {
    const Fixture room{.radius = 0.5f, .inward = true};
    EXPECT_THAT(enclosing_nodes(lamp_in(room)), IsEmpty());
}

TEST(EnclosedLights, ASpotIsEnclosedOnAllSides) {
    Scene scene = lamp_in({});
    scene.lights = {spot_down(0.4f)};
    EXPECT_THAT(enclosing_nodes(std::move(scene)), ElementsAre(1));
    // A cap below, or a floor, is what it lights, whether or not it is seen from there.
    const auto over_cap = [](float outer_rad) {
        SceneBuilder builder;
        builder.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, builder.material({}));
        builder.quad({-0.5f, 0.5f, 0.5f}, {1, 0, 0}, {0, 0, -1}, builder.material(two_sided()));
        Scene built = builder.take();
        built.lights = {spot_down(outer_rad)};
        return built;
    };
    const Vec3f beneath{0, 0.2f, 0.2f};
    EXPECT_THAT(enclosing_nodes(over_cap(0.4f), beneath), IsEmpty());
    EXPECT_THAT(enclosing_nodes(over_cap(1.2f), beneath), IsEmpty());
    EXPECT_THAT(enclosing_nodes(over_cap(0.4f), outside), IsEmpty());
}

TEST(EnclosedLights, FixturesPlacedByInstances) {
    Scene scene = lamp_in({.radius = 0.1f});
    place_last(scene, {placing({4, 3, 2}, {0, -2, 0})});  // the ball's centre stays at (0, 1, 0)
    scene.instances[0].node = 7;
    EXPECT_THAT(enclosing_nodes(std::move(scene)), ElementsAre(7));
}

TEST(EnclosedLights, TheWarningNamesBoth) {
    Scene scene = lamp_in({});
    scene.info.node_names = {"Floor", "Housing"};
    scene.info.light_names = {"Bulb"};
    Log log(Verbosity::quiet);
    warn_of_enclosed_lights(prepare(std::move(scene)), outside, log);
    ASSERT_EQ(log.warnings().size(), 1U);
    EXPECT_THAT(log.warnings()[0], testing::HasSubstr("light 0 Bulb"));
    EXPECT_THAT(log.warnings()[0], testing::HasSubstr("node 1 Housing"));
}

}  // namespace
}  // namespace obscura::test
