// tests/gltf/mesh_primitive_test.cpp - primitives of every mode and attribute as triangle lists.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_primitive.h"

#include "gltf/geometry/primitive_modes.h"
#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::gltf {
namespace {

using namespace test;

/// A fan of points on the X axis, so that vertex n is at x = n, y = n * n.
AssetBuilder curve(size_t vertices) {
    AssetBuilder builder;
    std::vector<float> positions;
    for (size_t i = 0; i < vertices; ++i) {
        const float x = static_cast<float>(i);
        positions.insert(positions.end(), {x, x * x, 0});
    }
    builder.add_accessor("VEC3", 5126, positions);
    return builder;
}

/// Vertices of the scene's triangles, identified by their x.
std::vector<int> corners(const Scene& scene) {
    std::vector<int> out;
    for (size_t i = 0; i < scene.indices.size() / 3 * 3; ++i) {  // without the padding
        const uint32_t index = scene.indices[i];
        out.push_back(static_cast<int>(scene.positions[3 * static_cast<size_t>(index)]));
    }
    return out;
}

/// Corners of a primitive of some mode over six vertices, with indices or (empty) without.
std::vector<int> corners_of(int mode, const std::vector<uint16_t>& indices) {
    AssetBuilder builder = curve(6);
    json primitive = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
    if (!indices.empty()) primitive["indices"] = builder.add_accessor("SCALAR", 5123, indices);
    builder.add_mesh(primitive);
    builder.add_root({{"mesh", 0}});
    const Loaded loaded = load_tree(builder.finished());
    EXPECT_TRUE(loaded.scene) << loaded.text();
    if (!loaded.scene) return {};
    return corners(*loaded.scene);
}

using Corners = std::vector<int>;

TEST(MeshPrimitive, ListsStripsAndFans) {
    EXPECT_EQ(corners_of(4, {}), (Corners{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(corners_of(4, {5, 4, 3}), (Corners{5, 4, 3}));
    EXPECT_EQ(corners_of(5, {}), (Corners{0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}));
    EXPECT_EQ(corners_of(6, {}), (Corners{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5}));
    EXPECT_EQ(corners_of(6, {5, 0, 1, 2}), (Corners{5, 0, 1, 5, 1, 2}));
}

/// Repeated vertices join two strips; what is drawn keeps the winding of its place.
TEST(MeshPrimitive, StripsTurnAtRepeatedVertices) {
    EXPECT_EQ(corners_of(5, {0, 1, 2, 2, 3, 3, 4, 5}), (Corners{0, 1, 2, 3, 5, 4}));
    EXPECT_EQ(corners_of(5, {0, 1, 2, 3, 3, 4, 5}), (Corners{0, 1, 2, 1, 3, 2, 3, 4, 5}));
}

TEST(MeshPrimitive, IndicesOf8And32Bits) {
    for (const int component : {5121, 5125}) {
        AssetBuilder builder = curve(6);
        const int indices =
            component == 5121
                ? builder.add_accessor("SCALAR", component, std::vector<uint8_t>{3, 4, 5})
                : builder.add_accessor("SCALAR", component, std::vector<uint32_t>{3, 4, 5});
        builder.add_mesh({{"attributes", {{"POSITION", 0}}}, {"indices", indices}});
        builder.add_root({{"mesh", 0}});
        const Loaded loaded = load_tree(builder.finished());
        ASSERT_TRUE(loaded.scene) << loaded.text();
        EXPECT_EQ(corners(*loaded.scene), (Corners{3, 4, 5}));
    }
}

TEST(MeshPrimitive, RestartIndexIsAnError) {  // C11
    AssetBuilder builder = curve(6);
    builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, 2, 0xFFFF, 3, 4, 5});
    builder.add_mesh({{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"mode", 5}});
    builder.add_root({{"mesh", 0}});
    const Loaded loaded = load_tree(builder.finished());
    EXPECT_EQ(loaded.id(), "E-MESH-INDEX");
    EXPECT_NE(loaded.text().find("index 3 is vertex 65535"), std::string::npos) << loaded.text();
}

/// Many primitives may share one long accessor: each keeps its own vertices only.
TEST(MeshPrimitive, FewOfManyVerticesAreKept) {
    AssetBuilder builder = curve(100);
    const int colors = builder.add_accessor("VEC3", 5126, std::vector<float>(300, 0.5f));
    const int indices =
        builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{90, 7, 55, 7, 90, 3});
    builder.add_mesh(
        {{"attributes", {{"POSITION", 0}, {"COLOR_0", colors}}}, {"indices", indices}});
    builder.add_root({{"mesh", 0}});
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(corners(*loaded.scene), (Corners{90, 7, 55, 7, 90, 3}));
    EXPECT_EQ(loaded.scene->positions.size(), 4U * 3 + 4);
    EXPECT_EQ(loaded.scene->attributes.size(), 4U * 4 + 4);
}

/// A vertex that no triangle uses may be anything.
TEST(MeshPrimitive, OnlyUsedPositionsMustBeFinite) {  // C12, C13
    for (const float bad : {NAN, INFINITY, -INFINITY, 2e18f}) {
        for (const bool used : {true, false}) {
            AssetBuilder builder;
            builder.add_accessor(
                "VEC3", 5126, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5});
            const float values[] = {bad};
            builder.bytes.replace(36, 4, reinterpret_cast<const char*>(values), 4);
            const uint16_t last = used ? 3 : 2;
            builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, last});
            builder.add_mesh({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
            builder.add_root({{"mesh", 0}});
            const Loaded loaded = load_tree(builder.finished());
            EXPECT_EQ(loaded.id(), used ? "E-MESH-POSITION" : "") << bad << loaded.text();
            if (!used) {
                EXPECT_EQ(position_of(*loaded.scene, 3), (std::vector<float>{0, 0, 0}));
            }
        }
    }
}

TEST(MeshPrimitive, QuantizedPositionsNeedTheExtension) {
    AssetBuilder builder;
    builder.add_accessor("VEC3", 5122, std::vector<int16_t>{0, 0, 0, 300, 0, 0, 0, -7, 0, 0, 0, 0});
    builder.tree["accessors"][0]["count"] = 3;
    builder.add_accessor("VEC3", 5120, std::vector<int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127});
    builder.tree["accessors"][1]["normalized"] = true;
    builder.add_mesh({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}});
    builder.add_root({{"mesh", 0}});
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-MESH-ATTRIBUTE");
    builder.tree["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(position_of(*loaded.scene, 1), (std::vector<float>{300, 0, 0}));
    EXPECT_EQ(position_of(*loaded.scene, 2), (std::vector<float>{0, -7, 0}));
    const int32_t normals = loaded.scene->primitives[0].normal_base;
    EXPECT_EQ(attribute_of(*loaded.scene, normals, 2, 3), (std::vector<float>{0, 0, 1}));
}

/// The second vertex's colour of a triangle whose COLOR_0 has this accessor.
template <typename T>
std::vector<float> color_of(const char* type, int component, const std::vector<T>& values) {
    AssetBuilder builder = triangle_builder();
    const int accessor = builder.add_accessor(type, component, values);
    builder.tree["accessors"][4].erase("min");  // JSON has no NaN
    builder.tree["accessors"][4].erase("max");
    if (component != 5126) builder.tree["accessors"][4]["normalized"] = true;
    builder.tree["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = accessor;
    const Loaded loaded = load_tree(builder.finished());
    EXPECT_TRUE(loaded.scene) << loaded.text();
    if (!loaded.scene) return {};
    return attribute_of(*loaded.scene, loaded.scene->primitives[0].color_base, 1, 4);
}

TEST(MeshPrimitive, VertexColorsOfEveryKind) {
    using F = std::vector<float>;
    EXPECT_EQ(color_of("VEC3", 5126, F{9, 9, 9, .5f, .25f, 2, 9, 9, 9}), (F{.5f, .25f, 2, 1}));
    EXPECT_EQ(color_of("VEC4", 5126, F{9, 9, 9, 9, .5f, .25f, 2, .75f, 9, 9, 9, 9}),
              (F{.5f, .25f, 2, .75f}));
    EXPECT_EQ(color_of("VEC4", 5121, std::vector<uint8_t>{9, 9, 9, 9, 255, 0, 51, 102, 9, 9, 9, 9}),
              (F{1, 0, .2f, .4f}));
    EXPECT_EQ(
        color_of("VEC4", 5123, std::vector<uint16_t>{9, 9, 9, 9, 65535, 0, 13107, 0, 9, 9, 9, 9}),
        (F{1, 0, .2f, 0}));
    EXPECT_EQ(color_of("VEC3", 5126, F{9, 9, 9, -1, NAN, INFINITY, 9, 9, 9}), (F{0, 1, 1, 1}));
}

TEST(MeshPrimitive, PrimitivesWithoutPositionsAreLeftOut) {
    AssetBuilder builder = triangle_builder();
    builder.tree["meshes"][0]["primitives"].push_back({{"attributes", {{"NORMAL", 1}}}});
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->primitives.size(), 1U);
    EXPECT_TRUE(loaded.warns("without POSITION are not drawn; meshes: mesh 0"));
}

TEST(MeshPrimitive, TriangleCounts) {
    EXPECT_EQ(triangle_count(4, 8), 2U);
    EXPECT_EQ(triangle_count(5, 8), 6U);
    EXPECT_EQ(triangle_count(6, 8), 6U);
    EXPECT_EQ(triangle_count(5, 2), 0U);
    EXPECT_EQ(triangle_count(6, 0), 0U);
    EXPECT_EQ(triangle_count(1, 8), 0U);
}

}  // namespace
}  // namespace obscura::gltf
