// tests/gltf/chosen_parts_test.cpp - parts and lights that the load options name.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/chosen_parts.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <set>

namespace obscura::gltf {
namespace {

using namespace test;

/// Two meshes of two materials, on nodes in a tree, a ball, and three lights:
/// Table (mesh Board) > Leg (mesh Pole) > Foot (mesh Pole) > light Glow; Ball; Desk > Lamp; Sun.
json furniture() {
    AssetBuilder builder = triangle_builder();
    json& tree = builder.tree;
    tree["materials"] = {{{"name", "Oak"}}, {{"name", "Steel"}}};
    tree["meshes"].push_back(tree["meshes"][0]);
    tree["meshes"][0]["name"] = "Board";
    tree["meshes"][0]["primitives"][0]["material"] = 0;
    tree["meshes"][1]["name"] = "Pole";
    json& pole = tree["meshes"][1]["primitives"];
    pole[0]["material"] = 1;
    pole.push_back(pole[0]);
    pole[1]["material"] = 0;
    tree["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "Glow"}, {"intensity", 10}},
        {{"type", "point"}, {"name", "Lamp"}, {"intensity", 20}},
        {{"type", "directional"}, {"name", "Sun"}, {"intensity", 30}}};
    const auto light = [](int index) { return json{{"KHR_lights_punctual", {{"light", index}}}}; };
    tree["nodes"] = {{{"name", "Table"}, {"mesh", 0}, {"children", {1}}},
                     {{"name", "Leg"}, {"mesh", 1}, {"children", {2}}},
                     {{"name", "Foot"}, {"mesh", 1}, {"translation", {0, 0, 3}}},
                     {{"name", "Desk"}, {"extensions", light(1)}},
                     {{"extensions", light(2)}}};
    tree["nodes"][2]["extensions"] = light(0);
    tree["scenes"][0]["nodes"] = {0, 3, 4};
    return builder.finished();
}

Loaded load_without(const std::vector<std::string>& hidden) {
    LoadOptions options;
    options.hidden = hidden;
    return load_tree(furniture(), options);
}

/// "node material" of each primitive that is drawn, with each instance of it.
std::multiset<std::string> drawn(const Loaded& loaded) {
    EXPECT_TRUE(loaded.scene) << loaded.text();
    std::multiset<std::string> out;
    if (!loaded.scene) return out;
    const Scene& scene = *loaded.scene;
    const auto add = [&](size_t index, int32_t node) {
        const Primitive& primitive = scene.primitives[index];
        out.insert(scene.info.node_names[static_cast<size_t>(node)] + " " +
                   scene.material_names[static_cast<size_t>(primitive.material)]);
    };
    for (size_t i = 0; i < static_cast<size_t>(scene.world_primitive_count); ++i)
        add(i, scene.primitives[i].node);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        for (int32_t i = 0; i < mesh.primitive_count; ++i)
            add(static_cast<size_t>(mesh.first_primitive + i), instance.node);
    }
    return out;
}

std::vector<float> intensities(const LightChoice& choice) {
    LoadOptions options;
    options.lights = choice;
    const Loaded loaded = load_tree(furniture(), options);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    std::vector<float> out;
    if (!loaded.scene) return out;
    for (const PunctualLight& light : loaded.scene->lights)
        out.push_back(light.intensity[0]);
    EXPECT_EQ(loaded.scene->info.light_names.size(), out.size());
    return out;
}

TEST(HiddenParts, NodesGoWithAllBelowThem) {
    using Names = std::multiset<std::string>;
    const Names all = {"Table Oak", "Leg Steel", "Leg Oak", "Foot Steel", "Foot Oak"};
    EXPECT_EQ(drawn(load_without({})), all);
    EXPECT_EQ(drawn(load_without({"Foot"})), (Names{"Table Oak", "Leg Steel", "Leg Oak"}));
    EXPECT_EQ(drawn(load_without({"L?g"})), (Names{"Table Oak"}));
    const Loaded nothing = load_without({"Table"});
    EXPECT_EQ(drawn(nothing), Names{});
    EXPECT_TRUE(nothing.scene->bounds.empty());
    EXPECT_EQ(nothing.scene->lights.size(), 2U);  // Glow is on the foot
    EXPECT_EQ(load_without({}).scene->lights.size(), 3U);
    EXPECT_EQ(load_without({"node 4"}).scene->lights.size(), 2U);
}

TEST(HiddenParts, MeshesAndMaterialsGoWhereverTheyAre) {
    using Names = std::multiset<std::string>;
    EXPECT_EQ(drawn(load_without({"Pole"})), (Names{"Table Oak"}));
    EXPECT_EQ(drawn(load_without({"Oak"})), (Names{"Leg Steel", "Foot Steel"}));
    EXPECT_EQ(drawn(load_without({"St*", "Board"})), (Names{"Leg Oak", "Foot Oak"}));
    EXPECT_FLOAT_EQ(load_without({"Foot"}).scene->bounds.high.z, 0);  // framed without it
    EXPECT_FLOAT_EQ(load_without({}).scene->bounds.high.z, 3);
}

TEST(HiddenParts, ACameraOnAHiddenNodeStays) {
    json tree = furniture();
    tree["cameras"][0] = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
    tree["nodes"][0]["camera"] = 0;
    LoadOptions options;
    options.hidden = {"Table"};
    EXPECT_EQ(load_tree(tree, options).scene->cameras.size(), 1U);
}

TEST(HiddenParts, UnknownOnesAreErrorsWithNamesThatAreNear) {
    const Loaded loaded = load_without({"Leg", "tabel"});
    EXPECT_EQ(loaded.code(), 64);
    EXPECT_EQ(loaded.id(), "E-HIDE-UNKNOWN");
    EXPECT_NE(loaded.text().find("'tabel' (did you mean 'Table'?)"), std::string::npos)
        << loaded.text();
}

/// "node material flags" of what is drawn.
std::multiset<std::string> flagged(const std::vector<VisibilityRule>& rules) {
    LoadOptions options;
    options.visibility = rules;
    const Loaded loaded = load_tree(furniture(), options);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    std::multiset<std::string> out;
    if (!loaded.scene) return out;
    const Scene& scene = *loaded.scene;
    const auto add = [&](size_t index, int32_t instance, int32_t node) {
        const Primitive& primitive = scene.primitives[index];
        const uint8_t flags = scene.visibility.of(static_cast<int32_t>(index), instance);
        if (flags == 0) return;
        out.insert(scene.info.node_names[static_cast<size_t>(node)] + " " +
                   scene.material_names[static_cast<size_t>(primitive.material)] + " " +
                   std::to_string(flags));
    };
    for (size_t i = 0; i < static_cast<size_t>(scene.world_primitive_count); ++i)
        add(i, -1, scene.primitives[i].node);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[i].mesh)];
        for (int32_t k = 0; k < mesh.primitive_count; ++k) {
            add(static_cast<size_t>(mesh.first_primitive + k),
                static_cast<int32_t>(i),
                scene.instances[i].node);
        }
    }
    return out;
}

TEST(VisibilityRules, NodesMeshesAndMaterialsGetTheirFlags) {
    using Names = std::multiset<std::string>;
    EXPECT_EQ(flagged({}), Names{});
    EXPECT_EQ(flagged({{"Leg", visibility_holdout}}),
              (Names{"Leg Steel 1", "Leg Oak 1", "Foot Steel 1", "Foot Oak 1"}));
    EXPECT_EQ(flagged({{"Foot", visibility_catcher}}), (Names{"Foot Steel 8", "Foot Oak 8"}));
    EXPECT_EQ(flagged({{"Board", visibility_no_shadow}}), (Names{"Table Oak 4"}));
    EXPECT_EQ(flagged({{"St*", visibility_no_camera}, {"F?ot", visibility_no_shadow}}),
              (Names{"Leg Steel 2", "Foot Steel 6", "Foot Oak 4"}));
}

TEST(VisibilityRules, UnknownOnesAreErrorsThatNameTheOption) {
    const std::pair<uint8_t, const char*> options[] = {{visibility_holdout, "holdout"},
                                                       {visibility_no_camera, "camera-invisible"},
                                                       {visibility_no_shadow, "no-shadow"},
                                                       {visibility_catcher, "catcher"}};
    for (const auto& [flag, name] : options) {
        LoadOptions load;
        load.visibility = {{"Leg", flag}, {"tabel", flag}};
        const Loaded loaded = load_tree(furniture(), load);
        EXPECT_EQ(loaded.code(), 64);
        EXPECT_EQ(loaded.id(), "E-VISIBILITY-UNKNOWN");
        EXPECT_NE(loaded.text().find("'tabel' (did you mean 'Table'?)"), std::string::npos);
        EXPECT_NE(loaded.text().find(name), std::string::npos) << loaded.text();
    }
}

TEST(LightChoice, LightsAreLeftOutOrScaledByLightOrNode) {
    EXPECT_EQ(intensities({}), (std::vector<float>{10, 20, 30}));
    EXPECT_EQ(intensities({.off = true}), std::vector<float>{});
    EXPECT_EQ(intensities({.factors = {{"Lamp", 0.5}}}), (std::vector<float>{10, 10, 30}));
    EXPECT_EQ(intensities({.factors = {{"Desk", 3}, {"S?n", 0}}}), (std::vector<float>{10, 60}));
    // The last one that fits counts, not the product.
    EXPECT_EQ(intensities({.factors = {{"*", 2}, {"Glow", 3}}}), (std::vector<float>{30, 40, 60}));
}

TEST(LightChoice, FactorsStayFinite) {
    EXPECT_EQ(intensities({.factors = {{"Sun", 1e30}}}).back(), 1e20F);
}

TEST(LightChoice, UnknownOnesAreErrorsThatListTheLights) {
    LoadOptions options;
    options.lights.factors = {{"Spotlight", 2}};
    const Loaded loaded = load_tree(furniture(), options);
    EXPECT_EQ(loaded.code(), 64);
    EXPECT_EQ(loaded.id(), "E-LIGHT-UNKNOWN");
    EXPECT_NE(loaded.text().find("'Glow', 'Foot', 'Lamp', 'Desk', 'Sun', 'node 4'"),
              std::string::npos)
        << loaded.text();
    EXPECT_NE(load_tree(triangle_asset(), options).text().find("there are no lights"),
              std::string::npos);
}

TEST(Subtree, TakesAllBelowTheNodesThatFit) {
    const TempFolder folder;
    Log log(Verbosity::quiet);
    const std::string text = furniture().dump();
    const auto asset =
        PosedAsset::open(folder.write("scene.gltf", text), LoadOptions{}, false, log);
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->subtree("Leg").value(), (std::vector<char>{0, 1, 1, 0, 0}));
    EXPECT_EQ(asset->subtree("*e*").value(), (std::vector<char>{1, 1, 1, 1, 1}));
    const auto missing = asset->subtree("Fot");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().id, "E-NODE-UNKNOWN");
    EXPECT_NE(missing.error().message.find("did you mean 'Foot'"), std::string::npos);
}

}  // namespace
}  // namespace obscura::gltf
