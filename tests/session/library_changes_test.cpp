// tests/session/library_changes_test.cpp - an asset that is changed between images of the library.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <algorithm>
#include <cmath>
#include <obscura/obscura.h>
#include <set>
#include <utility>

namespace obscura {
namespace {

/// Two boxes of one mesh under a lamp, seen from a place of its own.
class Changes : public testing::Test {
protected:
    static SmallScene two_boxes(const std::string& second) {
        SmallScene scene = box_scene();
        scene.nodes = R"({"name": "first", "mesh": 0}, {"name": "second", "mesh": 0, )" + second +
                      R"(}, {"extensions": {"KHR_lights_punctual": {"light": 0}}})";
        scene.roots = "0, 1, 2";
        scene.material = R"("pbrMetallicRoughness": {"metallicFactor": 0})";
        scene.more = R"(, "extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}})";
        return scene;
    }

    std::string write(const std::string& name, const SmallScene& scene) {
        folder_.write(name, gltf_text(scene));
        return (folder_ / name).string();
    }

    Asset open(const std::string& file) { return *session_.open(file); }

    Image render(const Asset& asset) {
        View view;
        view.width = 48;
        view.height = 32;
        view.eye = {3, 4, 14};
        view.target = {2, 0, 0};
        Sampling sampling;
        sampling.samples_per_pixel = 2;
        sampling.aov = {"id_node", "depth", "id_material"};
        Result<Image> image = session_.render(asset, view, {}, sampling);
        EXPECT_TRUE(image) << image.error().text;
        return image ? std::move(*image) : Image{};
    }

    static void expect_same(const Image& a, const Image& b) {
        EXPECT_TRUE(a.pixels == b.pixels);
        for (size_t i = 0; i < a.layers.size(); ++i)
            EXPECT_TRUE(a.layers[i].pixels == b.layers[i].pixels) << a.layers[i].name;
    }

    /// What moves is placed by a matrix of floats in place of having its vertices there.
    static void expect_close(const Image& a, const Image& b) {
        size_t differing = 0;
        for (size_t i = 0; i < a.layers[0].pixels.size(); ++i) {
            const bool is_same = a.layers[0].pixels[i] == b.layers[0].pixels[i];
            differing += is_same ? 0 : 1;
            if (is_same) {
                EXPECT_NEAR(a.layers[1].pixels[i], b.layers[1].pixels[i], 1e-3) << i;
            }
        }
        EXPECT_LE(differing, 2U);
    }

    static std::set<float> nodes_in(const Image& image) {
        return {image.layers[0].pixels.begin(), image.layers[0].pixels.end()};
    }

    TempFolder folder_;
    Session session_;
    const std::string far_ = write("far.gltf", two_boxes(R"("translation": [9, 0, 0])"));
};

TEST_F(Changes, ANodeIsSeenWhereItWasMoved) {
    const std::string moved = write(
        "moved.gltf", two_boxes(R"("translation": [3, 0.5, 1], "rotation": [0, 0.6, 0, 0.8])"));
    Asset asset = open(far_);
    render(asset);
    ASSERT_TRUE(asset.set("/nodes/1/translation", {3, 0.5, 1}));
    ASSERT_TRUE(asset.set("/nodes/1/rotation", {0, 0.6, 0, 0.8}));
    const Image once = render(asset);
    expect_close(once, render(open(moved)));
    ASSERT_TRUE(asset.set("/nodes/1/translation", {9, 0, 0}));
    ASSERT_TRUE(asset.set("/nodes/1/rotation", {0, 0, 0, 1}));
    expect_close(render(asset), render(open(far_)));
    ASSERT_TRUE(asset.set("/nodes/1/translation", {3, 0.5, 1}));
    ASSERT_TRUE(asset.set("/nodes/1/rotation", {0, 0.6, 0, 0.8}));
    expect_same(render(asset), once);
    asset.reset();
    expect_same(render(asset), render(open(far_)));
}

TEST_F(Changes, ANodeMovesAfterSomethingElseChanged) {
    // Images of the first change keep geometry in which the node stands still.
    SmallScene scene = two_boxes(R"("translation": [2, 1, 0])");
    scene.roots = "1, 2";  // one box alone, which is no instance while it stands still
    const std::string file = write("one.gltf", scene);
    const std::string lamp = "/extensions/KHR_lights_punctual/lights/0/intensity";
    Asset asset = open(file);
    ASSERT_TRUE(asset.set(lamp, {1.5}));
    render(asset);
    ASSERT_TRUE(asset.set("/nodes/1/translation", {3, 0.5, 1}));
    const Image later = render(asset);
    Asset at_once = open(file);
    ASSERT_TRUE(at_once.set(lamp, {1.5}));
    ASSERT_TRUE(at_once.set("/nodes/1/translation", {3, 0.5, 1}));
    expect_same(later, render(at_once));
}

TEST_F(Changes, AMatrixGivesWayToItsParts) {
    // A mirror, a quarter turn about X, and a place.
    const std::string matrix =
        write("matrix.gltf",
              two_boxes(R"("matrix": [-2, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 4, 1, 0, 1])"));
    const std::string moved = write(
        "moved.gltf", two_boxes(R"("matrix": [-2, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 5, 1, 0, 1])"));
    Asset asset = open(matrix);
    ASSERT_TRUE(asset.set("/nodes/1/translation/0", {5}));
    expect_close(render(asset), render(open(moved)));
    const std::string sheared = write(
        "sheared.gltf", two_boxes(R"("matrix": [1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 4, 1, 0, 1])"));
    const Result<void> refused = open(sheared).set("/nodes/1/translation", {0, 0, 0});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "E-SET-VALUE");
}

TEST_F(Changes, ANodeIsHiddenAndShown) {
    Asset asset = open(write("near.gltf", two_boxes(R"("translation": [3, 0, 0])")));
    const Image both = render(asset);
    EXPECT_EQ(nodes_in(both), (std::set<float>{0, 1, 2}));
    const std::string visible = "/nodes/1/extensions/KHR_node_visibility/visible";
    ASSERT_TRUE(asset.set(visible, {0}));
    EXPECT_EQ(nodes_in(render(asset)), (std::set<float>{0, 1}));
    ASSERT_TRUE(asset.set(visible, {1}));
    expect_close(render(asset), both);
}

TEST_F(Changes, AMaterialIsThatOfAFileThatHasIt) {
    SmallScene red = two_boxes(R"("translation": [9, 0, 0])");
    red.material = R"("pbrMetallicRoughness": {"metallicFactor": 0,
"baseColorFactor": [1, 0.25, 0, 1], "roughnessFactor": 0.5})";
    Asset asset = open(far_);
    const Image before = render(asset);
    ASSERT_TRUE(asset.set("/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 0.25, 0, 1}));
    ASSERT_TRUE(asset.set("/materials/0/pbrMetallicRoughness/roughnessFactor", {0.5}));
    const Image after = render(asset);
    EXPECT_FALSE(before.pixels == after.pixels);
    expect_same(after, render(open(write("red.gltf", red))));
}

TEST_F(Changes, ALampIsDimmed) {
    Asset asset = open(far_);
    const Image before = render(asset);
    ASSERT_TRUE(asset.set("/extensions/KHR_lights_punctual/lights/0/intensity", {1.5}));
    const Image after = render(asset);
    for (size_t i = 0; i < before.pixels.size(); i += before.channels.size())
        EXPECT_NEAR(after.pixels[i], 0.5f * before.pixels[i], 1e-5f);
}

TEST_F(Changes, ValuesStayWhenTheFileIsReadAgain) {
    Asset asset = open(far_);
    ASSERT_TRUE(asset.set("/nodes/1/translation", {3, 0, 0}));
    const Image once = render(asset);
    Sampling sampling;
    sampling.samples_per_pixel = 1;
    sampling.aov = {"uv"};  // reads the file for it
    ASSERT_TRUE(session_.render(asset, {}, {}, sampling));
    expect_same(render(asset), once);
}

TEST_F(Changes, ANodeHasAnotherMaterialThanItsMesh) {
    SmallScene scene = two_boxes(R"("translation": [3, 0, 0])");
    scene.material += R"(}, {"name": "red", "pbrMetallicRoughness": {"metallicFactor": 0,
"baseColorFactor": [1, 0, 0, 1]})";
    const std::string file = write("near.gltf", scene);
    const auto materials_of = [&](const Asset& asset) {
        const Image image = render(asset);
        std::set<std::pair<float, float>> out;  // node and material
        for (size_t i = 0; i < image.layers[0].pixels.size(); ++i)
            out.insert({image.layers[0].pixels[i], image.layers[2].pixels[i]});
        return out;
    };
    using Pairs = std::set<std::pair<float, float>>;
    Asset asset = open(file);
    const Image before = render(asset);
    EXPECT_EQ(materials_of(asset), (Pairs{{0, 0}, {1, 1}, {2, 1}}));
    ASSERT_TRUE(asset.assign_material(1, 1));
    EXPECT_EQ(materials_of(asset), (Pairs{{0, 0}, {1, 1}, {2, 2}}));
    const Image once = render(asset);
    ASSERT_TRUE(asset.set_variant(""));
    Sampling uv;
    uv.samples_per_pixel = 1;
    uv.aov = {"uv"};  // reads the file for it
    ASSERT_TRUE(session_.render(asset, {}, {}, uv));
    expect_same(render(asset), once);
    ASSERT_TRUE(asset.assign_material(0, 1));
    ASSERT_TRUE(asset.assign_material(1, 0));
    EXPECT_EQ(materials_of(asset), (Pairs{{0, 0}, {1, 2}, {2, 1}}));
    asset.reset();
    expect_same(render(asset), before);
}

TEST_F(Changes, MistakesAreNamed) {
    Asset asset = open(far_);
    for (const Result<void>& assigned : {asset.assign_material(7, 0),     // no such node
                                         asset.assign_material(1, 1),     // no such material
                                         asset.assign_material(2, 0)}) {  // a lamp
        ASSERT_FALSE(assigned);
        EXPECT_EQ(assigned.error().id, "E-SET-UNKNOWN");
    }
    const auto id = [&](const std::string& pointer, const std::vector<double>& value) {
        const Result<void> done = asset.set(pointer, value);
        return done ? "" : done.error().id;
    };
    EXPECT_EQ(id("/nodes/7/translation", {1, 2, 3}), "E-SET-UNKNOWN");
    EXPECT_EQ(id("/nodes/1/mesh", {0}), "E-SET-UNKNOWN");
    EXPECT_EQ(id("/nodes/1/translation", {1, 2}), "E-SET-VALUE");
    EXPECT_EQ(id("/nodes/1/weights", {1}), "E-SET-VALUE");
    EXPECT_EQ(id("/nodes/1/translation", {1, 2, std::nan("")}), "E-SET-VALUE");
    EXPECT_EQ(id("/nodes/1/rotation", {0, 0, 0, 0}), "E-SET-VALUE");
    EXPECT_EQ(id("/nodes/1/extensions/KHR_node_visibility/visible", {0.3}), "E-SET-VALUE");
    const Result<void> variant = asset.set_variant("red");
    ASSERT_FALSE(variant);
    EXPECT_EQ(variant.error().id, "E-VARIANT-UNKNOWN");
    const Result<void> same_material = asset.assign_material(1, 0);
    EXPECT_TRUE(same_material) << same_material.error().text;
    expect_same(render(asset), render(open(far_)));
}

}  // namespace
}  // namespace obscura
