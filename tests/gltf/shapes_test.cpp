// tests/gltf/shapes_test.cpp - analytic shapes in glTF: loading and refusals.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/shapes.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::HasSubstr;

/// An asset with one shape and one node that draws it.
AssetBuilder shape_builder(const json& shape, json node = json::object()) {
    AssetBuilder builder;
    builder.tree["extensions"]["OBSCURA_shape"]["shapes"][0] = shape;
    node["extensions"]["OBSCURA_shape"]["shape"] = 0;
    builder.add_root(node);
    return builder;
}

Loaded load_shape(const json& shape, const json& node = json::object()) {
    return load_tree(shape_builder(shape, node).finished());
}

TEST(Shapes, EveryTypeLoadsWithItsDefaults) {
    const std::vector<double> ball = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
    const json quadric = {{"coefficients", ball}, {"min", {-1, -1, -1}}, {"max", {1, 1, 1}}};
    for (const char* type :
         {"sphere", "box", "cylinder", "capsule", "plane", "disk", "cone", "quadric"}) {
        json shape = {{"type", type}};
        if (std::string(type) == "quadric") shape["quadric"] = quadric;
        const Loaded loaded = load_shape(shape);
        ASSERT_TRUE(loaded.scene) << type << ": " << loaded.text();
        EXPECT_EQ(loaded.warnings, "") << type;
        ASSERT_EQ(loaded.scene->shapes.size(), 1U);
        EXPECT_EQ(loaded.scene->world_primitive_count, 1);
        EXPECT_EQ(loaded.scene->info.shapes[0].name, type);
        EXPECT_FALSE(loaded.scene->bounds.empty());
    }
}

TEST(Shapes, OnlyMovedAndScaledAlikeTheyLieInTheWorld) {
    const json sphere = {{"type", "sphere"}, {"sphere", {{"radius", 0.25}}}};
    const Loaded world = load_shape(sphere, {{"translation", {1, 2, 3}}, {"scale", {2, 2, 2}}});
    ASSERT_TRUE(world.scene) << world.text();
    EXPECT_TRUE(world.scene->instances.empty());
    EXPECT_FLOAT_EQ(world.scene->shapes[0].size[0], 0.5F);
    EXPECT_FLOAT_EQ(world.scene->shapes[0].centre[2], 3.0F);
    EXPECT_EQ(world.scene->primitives[0].node, 0);
    const Loaded stretched = load_shape(sphere, {{"scale", {2, 1, -2}}});
    ASSERT_TRUE(stretched.scene) << stretched.text();
    ASSERT_EQ(stretched.scene->instances.size(), 1U);
    EXPECT_EQ(stretched.scene->instances[0].mirrored, 1);
    EXPECT_EQ(stretched.scene->world_primitive_count, 0);
    EXPECT_NEAR(stretched.scene->bounds.high.x, 0.5, 1e-5);
}

TEST(Shapes, MeshesKeepTheirPrimitivesBesideShapes) {
    AssetBuilder builder = triangle_builder();
    builder.add_root({{"mesh", 0}, {"translation", {5, 0, 0}}});
    builder.tree["extensions"]["OBSCURA_shape"]["shapes"][0] = {{"type", "box"}};
    json node;
    node["extensions"]["OBSCURA_shape"]["shape"] = 0;
    builder.add_root(node);
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    ASSERT_EQ(scene.primitives.size(), 2U);
    EXPECT_FALSE(is_mesh(scene.primitives[0]));
    ASSERT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.meshes[0].first_primitive, 1);
    EXPECT_TRUE(is_mesh(scene.primitives[1]));
}

TEST(Shapes, KhronosShapesAreDrawnWhereANodeSaysSo) {
    AssetBuilder builder;
    builder.tree["extensions"]["KHR_implicit_shapes"]["shapes"] = {
        {{"type", "somebody's"}}, {{"type", "sphere"}, {"sphere", {{"radius", 2}}}}};
    json own;
    own["extensions"]["OBSCURA_shape"]["implicitShape"] = 1;
    json khronos;
    khronos["extensions"]["KHR_implicit_shapes"]["shape"] = 1;
    builder.add_root(own);
    builder.add_root(khronos);
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->shapes.size(), 2U);
    EXPECT_EQ(loaded.scene->info.shapes[0].count, 2U);
    builder.tree["nodes"][1]["extensions"]["KHR_implicit_shapes"]["shape"] = 0;
    const Loaded unknown = load_tree(builder.finished());
    EXPECT_EQ(unknown.id(), "E-SHAPE-TYPE");
    EXPECT_THAT(unknown.text(), HasSubstr("#/nodes/1"));
}

TEST(Shapes, QuadricsAreCentredOnTheirBox) {
    // The unit sphere around (3, 0, 0): (x - 3)^2 + y^2 + z^2 - 1.
    const std::vector<double> k = {1, 1, 1, 0, 0, 0, -6, 0, 0, 8};
    const Loaded loaded =
        load_shape({{"type", "quadric"},
                    {"quadric", {{"coefficients", k}, {"min", {2, -1, -1}}, {"max", {4, 1, 1}}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const ShapeRecord& record = loaded.scene->shapes[0];
    EXPECT_FLOAT_EQ(record.centre[0], 3);
    EXPECT_NEAR(record.k[6] / record.k[0], 0, 1e-6);
    EXPECT_NEAR(record.k[9] / record.k[0], -1, 1e-6);
}

TEST(Shapes, ACapsuleInsideItsOwnSphereIsThatSphere) {
    const Loaded loaded =
        load_shape({{"type", "capsule"},
                    {"capsule", {{"height", 0.5}, {"radiusTop", 2}, {"radiusBottom", 0.1}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const ShapeRecord& record = loaded.scene->shapes[0];
    EXPECT_EQ(record.kind, static_cast<int32_t>(ShapeKind::sphere));
    EXPECT_FLOAT_EQ(record.centre[1], 0.25F);
}

TEST(Shapes, ParticlesFillBlocks) {
    AssetBuilder builder = shape_builder({{"type", "spheres"}});
    std::vector<float> positions;
    std::vector<float> radii;
    for (int i = 0; i < 20; ++i) {
        positions.insert(positions.end(), {static_cast<float>(i), 0, 0});
        radii.push_back(0.1F * static_cast<float>(i + 1));
    }
    builder.tree["extensions"]["OBSCURA_shape"]["shapes"][0]["spheres"] = {
        {"positions", builder.add_accessor("VEC3", 5126, positions)},
        {"radii", builder.add_accessor("SCALAR", 5126, radii)}};
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->spheres.size(), 2U * sphere_block_floats);
    EXPECT_EQ(loaded.scene->info.shapes[0].count, 20U);
    for (size_t i = 0; i < 20; ++i) {  // in any order, each with its own radius
        const float* at = &loaded.scene->spheres[sphere_word(i)];
        EXPECT_NEAR(at[3 * sphere_block], 0.1F * (at[0] + 1), 1e-6F);
    }
    EXPECT_NEAR(loaded.scene->bounds.high.x, 21, 1e-3);
    builder.tree["extensions"]["OBSCURA_shape"]["shapes"][0]["spheres"]["positions"] = 1;
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-SHAPE-ACCESSOR");
}

TEST(Shapes, ParticlesMustFitTogetherAndBeCountable) {
    AssetBuilder builder = shape_builder({{"type", "spheres"}});
    json& spheres = builder.tree["extensions"]["OBSCURA_shape"]["shapes"][0]["spheres"];
    const auto positions = builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 0, 1, 0, 0});
    spheres = {{"positions", positions},
               {"radii", builder.add_accessor("SCALAR", 5126, std::vector<float>{1})}};
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-SHAPE-SPHERES");
    json tree = builder.finished();
    for (json& accessor : tree["accessors"]) {  // zeros without data
        accessor["count"] = (1U << 29) + 1;
        accessor.erase("bufferView");
    }
    EXPECT_EQ(load_tree(tree).id(), "E-LIMIT-SPHERES");
    EXPECT_EQ(load_tree(tree).code(), 77);
}

struct BadShape {
    const char* text;
    const char* id;
    const char* where;
};

TEST(Shapes, BadOnesAreRefusedWithTheirPlace) {
    const BadShape cases[] = {
        {R"({"type": "torus"})", "E-SHAPE-TYPE", "/shapes/0/type"},
        {R"({"type": "sphere", "sphere": {"radius": 0}})", "E-SHAPE-SIZE", "/sphere/radius"},
        {R"({"type": "sphere", "sphere": {"radius": -1}})", "E-SHAPE-SIZE", "/sphere/radius"},
        {R"({"type": "sphere", "sphere": {"radius": 1e30}})", "E-SHAPE-SIZE", "/sphere/radius"},
        {R"({"type": "sphere", "sphere": {"radius": "1"}})", "E-JSON-TYPE", "/sphere/radius"},
        {R"({"type": "sphere", "box": {}})", "E-SHAPE-TYPE", "/shapes/0/box"},
        {R"({"type": "box", "box": {"size": [1, 0, 1]}})", "E-SHAPE-SIZE", "/box/size"},
        {R"({"type": "box", "box": {"size": [1, 1]}})", "E-JSON-TYPE", "/box/size"},
        {R"({"type": "cylinder", "cylinder": {"radiusTop": 0, "radiusBottom": 0}})",
         "E-SHAPE-SIZE",
         "/cylinder/radiusTop"},
        {R"({"type": "disk", "disk": {"innerRadius": 0.5}})", "E-SHAPE-SIZE", "/innerRadius"},
        {R"({"type": "plane", "plane": {"sizeX": 0}})", "E-SHAPE-SIZE", "/plane/sizeX"},
        {R"({"type": "quadric", "quadric": {"coefficients": [0,0,0,0,0,0,0,0,0,1],
             "min": [-1,-1,-1], "max": [1,1,1]}})",
         "E-SHAPE-QUADRIC",
         "/coefficients"},
        {R"({"type": "quadric", "quadric": {"coefficients": [1,0,0,0,0,0,0,0,0,1],
             "min": [1,-1,-1], "max": [1,1,1]}})",
         "E-SHAPE-SIZE",
         "/quadric/max"},
        {R"({"type": "quadric", "quadric": {"coefficients": [1,0,0,0,0,0,0,0,0,1], "min": [0,0,0],
             "max": [1,1,1], "projection": "oblique"}})",
         "E-SHAPE-PROJECTION",
         "/projection"},
    };
    for (const BadShape& bad : cases) {
        const Loaded loaded = load_shape(json::parse(bad.text));
        EXPECT_EQ(loaded.code(), 65) << bad.text;
        EXPECT_EQ(loaded.id(), bad.id) << bad.text;
        EXPECT_THAT(loaded.text(), HasSubstr(bad.where)) << bad.text;
    }
}

TEST(Shapes, NodesMustNameOneShapeThatExists) {
    AssetBuilder builder = shape_builder({{"type", "sphere"}});
    builder.tree["nodes"][0]["extensions"]["OBSCURA_shape"] = {{"shape", 1}};
    EXPECT_THAT(load_tree(builder.finished()).text(), HasSubstr("#/nodes/0"));
    builder.tree["nodes"][0]["extensions"]["OBSCURA_shape"] = {{"material", 0}};
    EXPECT_EQ(load_tree(builder.finished()).code(), 65);
    builder.tree["nodes"][0]["extensions"]["OBSCURA_shape"] = json::object();
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-SHAPE-NODE");
    builder.tree["nodes"][0] = {{"extensions", {{"OBSCURA_shape", {{"shape", 0}}}}},
                                {"scale", {1e18, 1e18, 1e18}},
                                {"translation", {1e18, 0, 0}}};
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-NODE-RANGE");
    builder.tree["nodes"][0]["scale"] = {1, 0, 1};
    const Loaded flat = load_tree(builder.finished());
    ASSERT_TRUE(flat.scene) << flat.text();
    EXPECT_TRUE(flat.warns("not drawn"));
}

}  // namespace
}  // namespace obscura::gltf
