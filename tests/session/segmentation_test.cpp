// tests/session/segmentation_test.cpp - masks of films: which nodes fit, and what the list says.
// SPDX-License-Identifier: Apache-2.0
#include "session/segmentation.h"

#include "base/json/json.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

/// Three nodes; the second has a mesh of two materials through an instance.
Scene small_scene() {
    Scene scene;
    scene.info.node_names = {"a", "b", "c"};
    scene.info.node_parents = {-1, 0, 0};
    scene.info.node_meshes = {-1, 0, -1};
    scene.info.meshes = {{"vase", 2}};
    scene.materials.resize(3);
    scene.material_names = {"default material", "clay", "glaze"};
    scene.material_numbers = {-1, 0, 1};
    scene.primitives.resize(3);
    scene.primitives[0].node = 2;
    scene.primitives[1].material = 2;
    scene.primitives[2].material = 1;
    scene.world_primitive_count = 1;
    scene.meshes = {{1, 2, 0}};
    scene.instances.resize(1);
    scene.instances[0].node = 1;
    return scene;
}

Film film_of(int width, const std::vector<float>& ids) {
    Film film;
    film.width = width;
    film.height = static_cast<int>(ids.size()) / width;
    film.layers.push_back({segmentation_layer(), {}});
    film.layers.back().pixels.resize(ids.size());
    std::copy(ids.begin(), ids.end(), film.layers.back().pixels.begin());
    return film;
}

TEST(Segmentation, ListsVisibleNodesWithTheirMaterials) {
    const Film film = film_of(4, {0, 2, 2, 0, 0, 0, 2, 3});
    const Json list = Json::parse(segmentation_of(film, small_scene()).document);
    ASSERT_EQ(list["segments"].size(), 2U);
    const Json& vase = list["segments"][0];
    EXPECT_EQ(vase["node"], "/a/b");
    EXPECT_EQ(vase["mesh"], "vase");
    EXPECT_EQ(vase["materials"], Json({"clay", "glaze"}));
    EXPECT_EQ(vase["box"], Json({{"x", 1}, {"y", 0}, {"width", 2}, {"height", 2}}));
    EXPECT_EQ(vase["pixels"], 3);
    EXPECT_EQ(list["segments"][1]["materials"], Json({"default material"}));
    EXPECT_EQ(list["segments"][1]["mesh"], "");
}

TEST(Segmentation, OfAFilmWithOverscanShowsTheFrameAlone) {
    Film film = film_of(4, {1, 1, 1, 1, 1, 2, 2, 1, 1, 1, 1, 1});
    film.part_of = ImagePart{2, 1, -1, -1};
    const Segmentation made = segmentation_of(film, small_scene());
    ASSERT_EQ(made.ids.pixels.size(), 2U);
    const Json list = Json::parse(made.document);
    ASSERT_EQ(list["segments"].size(), 1U);
    EXPECT_EQ(list["segments"][0]["id"], 2);
    EXPECT_EQ(list["segments"][0]["box"], Json({{"x", 0}, {"y", 0}, {"width", 2}, {"height", 1}}));
}

TEST(Segmentation, HasIdsOf16Bits) {
    Scene scene;
    scene.info.node_names.resize(65535);
    EXPECT_TRUE(check_segmentation(scene));
    scene.info.node_names.emplace_back();
    const Result<void> refused = check_segmentation(scene);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "E-SEG-IDS");
}

}  // namespace
}  // namespace obscura
