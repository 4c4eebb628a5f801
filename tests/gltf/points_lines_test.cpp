// tests/gltf/points_lines_test.cpp - points and lines of every mode: positions and colours.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/points_lines.h"

#include "gltf/geometry/primitive_modes.h"
#include "gltf/gltf_files.h"
#include "gltf/images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace obscura::gltf {
namespace {

using namespace test;

using Indices = std::vector<uint32_t>;

TEST(PrimitiveModes, PointsAndLinesAsLists) {
    EXPECT_EQ(element_list({4, 5, 6}, 0).vertices, (Indices{4, 5, 6}));
    EXPECT_EQ(element_list({4, 5, 6, 7}, 1).vertices, (Indices{4, 5, 6, 7}));
    EXPECT_EQ(element_list({4, 5, 6}, 1).vertices, (Indices{4, 5}));
    EXPECT_TRUE(element_list({4, 5, 6}, 1).leftover);
    EXPECT_EQ(element_list({4, 5, 6}, 2).vertices, (Indices{4, 5, 5, 6, 6, 4}));
    EXPECT_EQ(element_list({4, 5, 6}, 3).vertices, (Indices{4, 5, 5, 6}));
    EXPECT_EQ(element_list({4, 4, 6}, 3).vertices, (Indices{4, 6}));
    EXPECT_TRUE(element_list({4}, 3).leftover);
    EXPECT_FALSE(element_list({4, 5}, 3).leftover);
}

/// Vertex n is at (n, n * n, 0) and has the red n / 8.
AssetBuilder curve(size_t vertices, int mode, const std::vector<uint16_t>& indices = {}) {
    AssetBuilder builder;
    std::vector<float> positions;
    std::vector<float> colors;
    for (size_t i = 0; i < vertices; ++i) {
        const auto x = static_cast<float>(i);
        positions.insert(positions.end(), {x, x * x, 0});
        colors.insert(colors.end(), {x / 8, 0.5F, 1});
    }
    const int position = builder.add_accessor("VEC3", 5126, positions);
    const int color = builder.add_accessor("VEC3", 5126, colors);
    json primitive = {{"attributes", {{"POSITION", position}, {"COLOR_0", color}}}, {"mode", mode}};
    if (!indices.empty()) primitive["indices"] = builder.add_accessor("SCALAR", 5123, indices);
    builder.add_mesh(primitive);
    builder.add_root({{"mesh", 0}});
    return builder;
}

Scene load_curve(const AssetBuilder& builder) {
    Loaded loaded = load_tree(builder.finished());
    EXPECT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    return loaded.scene ? std::move(*loaded.scene) : Scene{};
}

/// The segments of a scene's lines as pairs of x.
std::vector<std::pair<int, int>> segments(const Scene& scene) {
    std::vector<std::pair<int, int>> out;
    for (const uint32_t from : scene.curve_segments) {
        const float* p = &scene.curve_points[size_t{from} * 4];
        EXPECT_EQ(p[1], p[0] * p[0]);
        EXPECT_EQ(p[5], p[4] * p[4]);
        out.emplace_back(static_cast<int>(p[0]), static_cast<int>(p[4]));
    }
    return out;
}

using Segments = std::vector<std::pair<int, int>>;

TEST(PointsLines, LinesLoopsAndStrips) {
    EXPECT_EQ(segments(load_curve(curve(4, 1))), (Segments{{0, 1}, {2, 3}}));
    EXPECT_EQ(segments(load_curve(curve(4, 2))), (Segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}}));
    EXPECT_EQ(segments(load_curve(curve(4, 3))), (Segments{{0, 1}, {1, 2}, {2, 3}}));
    EXPECT_EQ(segments(load_curve(curve(5, 3, {4, 0, 2}))), (Segments{{4, 0}, {0, 2}}));
    EXPECT_EQ(segments(load_curve(curve(5, 1, {4, 0, 2, 3}))), (Segments{{4, 0}, {2, 3}}));
}

/// Connected segments share points, others have none in common: Embree relies on that.
TEST(PointsLines, NeighboursShareAPoint) {
    EXPECT_EQ(load_curve(curve(4, 1)).curve_segments, (Indices{0, 2}));
    EXPECT_EQ(load_curve(curve(4, 3)).curve_segments, (Indices{0, 1, 2}));
    EXPECT_EQ(load_curve(curve(5, 1, {0, 1, 1, 2, 3, 4})).curve_segments, (Indices{0, 1, 3}));
}

TEST(PointsLines, ColoursFollowTheVertices) {
    const Scene lines = load_curve(curve(5, 3, {4, 0, 2}));
    ASSERT_EQ(lines.primitives.size(), 1U);
    const Primitive& primitive = lines.primitives[0];
    EXPECT_EQ(primitive.geometry, static_cast<int32_t>(GeometryKind::curves));
    EXPECT_TRUE(is_point_or_line(primitive));
    EXPECT_EQ(attribute_of(lines, primitive.color_base, 0, 4),
              (std::vector<float>{0.5F, 0.5F, 1, 1}));
    EXPECT_EQ(attribute_of(lines, primitive.color_base, 2, 4),
              (std::vector<float>{0.25F, 0.5F, 1, 1}));

    const Scene points = load_curve(curve(40, 0));
    ASSERT_EQ(points.primitives.size(), 1U);
    EXPECT_EQ(points.info.points_in_world, 40U);
    for (uint32_t i = 0; i < 40; ++i) {
        const float x = points.spheres[sphere_word(size_t{i})];
        const std::vector<float> color =
            attribute_of(points, points.primitives[0].color_base, i, 4);
        EXPECT_EQ(color[0], x / 8) << i;
    }
}

/// A stretched node moves the vertices, several nodes place one mesh: all is in world space.
TEST(PointsLines, EveryNodePlacesThemInTheWorld) {
    AssetBuilder builder = curve(3, 3);
    builder.tree["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    builder.tree["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
    builder.add_root({{"mesh", 0}, {"scale", {-1, 3, 1}}, {"translation", {0, 0, 5}}});
    const Scene scene = load_curve(builder);
    EXPECT_EQ(scene.world_primitive_count, 4);
    EXPECT_EQ(scene.instances.size(), 2U) << "the triangles are shared";
    ASSERT_EQ(scene.curve_segments.size(), 4U);
    const float* second = &scene.curve_points[size_t{scene.curve_segments[3]} * 4];
    EXPECT_EQ((std::vector<float>{second[4], second[5], second[6]}),
              (std::vector<float>{-2, 12, 5}));
    EXPECT_EQ(scene.info.points_in_world, 6U);
    EXPECT_EQ(scene.info.line_segments_in_world, 4U);
    EXPECT_EQ(scene.primitives[0].node, 0);
    EXPECT_EQ(scene.primitives[3].node, 1);
    EXPECT_EQ(scene.bounds.low.x, -2);
    EXPECT_EQ(scene.bounds.high.y, 12);
}

TEST(PointsLines, SegmentsWithoutLengthAreLeftOut) {
    AssetBuilder builder;
    const int position = builder.add_accessor(
        "VEC3", 5126, std::vector<float>{0, 0, 0, 0, 0, 0, 1, 0, 0, 7, 7, 7, 7, 7, 7});
    builder.add_mesh({{"attributes", {{"POSITION", position}}}, {"mode", 3}});
    builder.add_mesh(
        {{"attributes", {{"POSITION", position}}},
         {"mode", 1},
         {"indices", builder.add_accessor("SCALAR", 5121, std::vector<uint8_t>{3, 4})}});
    builder.add_root({{"mesh", 0}});
    builder.add_root({{"mesh", 1}});
    const Scene scene = load_curve(builder);
    EXPECT_EQ(scene.curve_segments.size(), 2U);
    EXPECT_EQ(scene.primitives.size(), 1U);
}

TEST(PointsLines, HaveARadiusBeforeAnyCamera) {
    const Scene scene = load_curve(curve(4, 3));
    const double diagonal = std::sqrt(9.0 + 81.0);
    for (size_t i = 3; i < scene.curve_points.size(); i += 4) {
        EXPECT_NEAR(scene.curve_points[i], diagonal / 1000, 1e-6);
    }
    const Scene alone = load_curve(curve(1, 0));
    EXPECT_NEAR(alone.spheres[3 * sphere_block], 0.005, 1e-7);
}

TEST(PointsLines, FaultsAreFoundAsInMeshes) {
    AssetBuilder builder = curve(4, 3, {0, 9});
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-MESH-INDEX");
    builder = curve(4, 0);
    builder.tree["accessors"][1]["count"] = 2;
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-MESH-COUNT");
}

/// glTF 2.0, Point and Line Materials.
TEST(PointsLines, WithoutNormalsAreNotLit) {
    const json material = {
        {"emissiveFactor", {0.25, 0, 0.5}},
        {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.125, 0.75}}}}};
    for (const int mode : {0, 3}) {
        AssetBuilder builder = curve(3, mode);
        builder.tree["materials"].push_back(material);
        builder.tree["meshes"][0]["primitives"][0]["material"] = 0;
        const Scene colored = load_curve(builder);
        const Primitive& record = colored.primitives[0];
        const Material& sum = colored.materials[static_cast<size_t>(record.material)];
        EXPECT_NE(sum.flags & material_unlit, 0U);
        EXPECT_EQ((std::vector<float>(sum.base_color, sum.base_color + 4)),
                  (std::vector<float>{0.5F, 0.25F, 0.125F, 0.75F}));
        EXPECT_EQ(sum.emission[2], 0.5F) << "is added to what COLOR_0 multiplies";
        const uint32_t vertex = mode == 0 ? 0 : 2;
        const float red =
            colored.primitives[0].geometry == static_cast<int32_t>(GeometryKind::curves)
                ? 0.25F
                : colored.spheres[sphere_word(size_t{0})] / 8;
        EXPECT_EQ(attribute_of(colored, record.color_base, vertex, 4),
                  (std::vector<float>{red, 0.5F, 1, 1}));

        builder.tree["meshes"][0]["primitives"][0]["attributes"].erase("COLOR_0");
        const Scene plain = load_curve(builder);
        const Material& one = plain.materials[static_cast<size_t>(plain.primitives[0].material)];
        EXPECT_NE(one.flags & material_unlit, 0U);
        EXPECT_EQ(one.base_color[0], 0.5F);
        EXPECT_EQ(one.emission[0], 0.25F);
        EXPECT_EQ(plain.material_numbers[static_cast<size_t>(plain.primitives[0].material)], 0);
    }
}

TEST(PointsLines, WithNormalsAreLitAndKeepThem) {
    for (const int mode : {0, 3}) {
        AssetBuilder builder = curve(3, mode);
        builder.tree["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
            builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 1, 0, 1, 0, NAN, 0, 0});
        builder.add_root({{"mesh", 0}, {"rotation", {1, 0, 0, 0}}});
        const Scene scene = load_curve(builder);
        ASSERT_EQ(scene.primitives.size(), 2U);
        const Primitive& own = scene.primitives[0];
        const Primitive& turned = scene.primitives[1];  // half round about x
        const uint32_t flags = scene.materials[static_cast<size_t>(own.material)].flags;
        EXPECT_EQ(flags & material_unlit, 0U);
        EXPECT_NE(flags & material_double_sided, 0U) << "alike from both sides";
        const auto normal = [&](const Primitive& primitive, size_t number) {
            size_t vertex = number;
            if (mode != 0)
                vertex += scene.curve_segments[static_cast<size_t>(primitive.first_triangle)];
            if (mode == 0) vertex += static_cast<size_t>(primitive.first_triangle);
            return attribute_of(scene, primitive.normal_base, static_cast<uint32_t>(vertex), 3);
        };
        std::vector<float> sums(3);
        for (size_t i = 0; i < 3; ++i) {
            const std::vector<float> n = normal(own, i);
            const std::vector<float> m = normal(turned, i);
            EXPECT_FLOAT_EQ(m[1], -n[1]);
            EXPECT_FLOAT_EQ(m[2], -n[2]);
            for (size_t c = 0; c < 3; ++c)
                sums[c] += n[c];
        }
        EXPECT_EQ(sums, (std::vector<float>{0, 1, 1})) << "what is not finite is 0";
    }
}

/// A surface element has no inside.
TEST(PointsLines, WithNormalsAreNoSolids) {
    AssetBuilder builder = curve(2, 0);
    builder.tree["extensionsUsed"] = {"KHR_materials_volume", "KHR_materials_transmission"};
    builder.tree["materials"].push_back(
        {{"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1},
             {"attenuationDistance", 1},
             {"attenuationColor", {0, 1, 0}}}}}}});
    json& primitive = builder.tree["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["attributes"]["NORMAL"] =
        builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 1, 0, 0, 1});
    const Scene scene = load_curve(builder);
    const Material& m = scene.materials[static_cast<size_t>(scene.primitives[0].material)];
    ASSERT_GE(m.layers, 0);
    const MaterialLayers& layers = scene.layers[static_cast<size_t>(m.layers)];
    EXPECT_EQ(layers.transmission, 1);
    EXPECT_EQ(layers.medium, 0);
}

TEST(PointsLines, UnlitMaterialsStayAsTheyAre) {
    AssetBuilder builder = curve(3, 0);
    builder.tree["extensionsUsed"] = {"KHR_materials_unlit"};
    builder.tree["materials"].push_back(
        {{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_unlit", json::object()}}}});
    builder.tree["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene scene = load_curve(builder);
    EXPECT_LE(attribute_of(scene, scene.primitives[0].color_base, 0, 4)[0], 0.25F);
    EXPECT_EQ(attribute_of(scene, scene.primitives[0].color_base, 0, 4)[1], 0.5F);
    EXPECT_EQ(scene.materials[static_cast<size_t>(scene.primitives[0].material)].emission[0], 0);
}

/// Each vertex keeps its own place in the texture, of every set that the material reads.
TEST(PointsLines, HaveTextureCoordinates) {
    for (const bool lit : {false, true}) {
        for (const int mode : {0, 3}) {
            AssetBuilder builder = curve(3, mode);
            builder.tree["images"][0]["uri"] = png_uri(2, 2);
            builder.tree["textures"][0]["source"] = 0;
            builder.tree["materials"].push_back(
                {{"normalTexture", {{"index", 0}}},
                 {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 2}}}}},
                 {"emissiveTexture", {{"index", 0}}}});
            json& primitive = builder.tree["meshes"][0]["primitives"][0];
            primitive["material"] = 0;
            json& attributes = primitive["attributes"];
            attributes["TEXCOORD_0"] =
                builder.add_accessor("VEC2", 5126, std::vector<float>{0, 0, 0.5F, 1, 1, 2});
            attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
            attributes["TEXCOORD_2"] =
                builder.add_accessor("VEC2", 5126, std::vector<float>{1, 0, 2, 0, 3, 0});
            if (lit) {
                attributes["NORMAL"] = builder.add_accessor(
                    "VEC3", 5126, std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
            }
            const Scene scene = load_curve(builder);
            ASSERT_EQ(scene.primitives.size(), 1U);
            const Primitive& record = scene.primitives[0];
            EXPECT_EQ(record.uv_base[1], no_attribute) << "nothing reads it";
            for (uint32_t i = 0; i < 3; ++i) {
                const float x = mode == 3 ? scene.curve_points[size_t{i} * 4]
                                          : scene.spheres[sphere_word(size_t{i})];
                EXPECT_EQ(attribute_of(scene, record.uv_base[0], i, 2)[1], x);
                EXPECT_EQ(attribute_of(scene, record.uv_base[2], i, 2)[0], x + 1);
            }
            const Material& material = scene.materials[static_cast<size_t>(record.material)];
            EXPECT_GE(material.base_color_texture.texture, 0);
            EXPECT_GE(material.emissive_texture.texture, 0);
            EXPECT_EQ(material.normal_texture.texture, -1) << "there are no tangents";
            EXPECT_EQ((material.flags & material_unlit) != 0, !lit);
        }
    }
}

}  // namespace
}  // namespace obscura::gltf
