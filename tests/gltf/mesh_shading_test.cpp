// tests/gltf/mesh_shading_test.cpp - normals and tangents: given, broken, missing.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace obscura::gltf {
namespace {

/// Two triangles that share an edge: a square in the XY plane, folded up along x = 1 if asked.
MeshPrimitive square(float fold = 0) {
    MeshPrimitive primitive;
    primitive.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, fold, 2, 1, fold};
    primitive.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    primitive.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    primitive.uvs[0] = {0, 1, 1, 1, 1, 0, 0, 0, 2, 1, 2, 0};
    return primitive;
}

MaterialNeeds normal_mapped() {
    MaterialNeeds needs;
    needs.uv_sets = 1;
    needs.tangents = true;
    needs.normal_map.texture = 0;
    return needs;
}

std::vector<float> vertex(const std::vector<float>& values, size_t index, size_t width) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(index * width);
    return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

using F = std::vector<float>;

TEST(MeshShading, NormalsBecomeUnit) {
    MeshPrimitive primitive = square();
    primitive.normals[2] = 5;
    finish_shading(primitive, {});
    EXPECT_EQ(vertex(primitive.normals, 0, 3), (F{0, 0, 1}));
    EXPECT_EQ(primitive.issues, 0U);
    EXPECT_TRUE(primitive.tangents.empty());
}

TEST(MeshShading, BadNormalsBecomeTheTrianglesOwn) {  // C17
    for (const float bad : {0.0f, NAN, INFINITY}) {
        MeshPrimitive primitive = square(1);
        primitive.normals[2] = bad;   // vertex 0: in the flat triangles only
        primitive.normals[14] = bad;  // vertex 4: in a folded one only
        finish_shading(primitive, {});
        EXPECT_EQ(primitive.issues, issue_bit(MeshIssue::bad_normals));
        EXPECT_EQ(vertex(primitive.normals, 0, 3), (F{0, 0, 1}));
        const float half = std::sqrt(0.5f);
        EXPECT_NEAR(primitive.normals[12], -half, 1e-6f);
        EXPECT_NEAR(primitive.normals[14], half, 1e-6f);
    }
}

TEST(MeshShading, BadNormalsOfUnusedVerticesAreNobodysBusiness) {
    MeshPrimitive primitive = square();
    primitive.positions.insert(primitive.positions.end(), {9, 9, 9});
    primitive.normals.insert(primitive.normals.end(), {0, 0, 0});
    finish_shading(primitive, {});
    EXPECT_EQ(primitive.issues, 0U);
}

TEST(MeshShading, DegenerateTrianglesGiveAUnitNormalToo) {
    MeshPrimitive primitive;
    primitive.positions = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    primitive.normals = F(9, 0);
    primitive.indices = {0, 1, 2};
    finish_shading(primitive, {});
    EXPECT_EQ(vertex(primitive.normals, 1, 3), (F{0, 0, 1}));
}

TEST(MeshShading, GivenTangentsAreMadeUnit) {
    MeshPrimitive primitive = square();
    for (int i = 0; i < 6; ++i)
        primitive.tangents.insert(primitive.tangents.end(), {3, 0, 0, -0.5f});
    finish_shading(primitive, normal_mapped());
    EXPECT_EQ(vertex(primitive.tangents, 3, 4), (F{1, 0, 0, -1}));
    EXPECT_EQ(primitive.positions.size(), 18U);
}

TEST(MeshShading, TangentsWithoutANormalMapAreDropped) {
    MeshPrimitive primitive = square();
    primitive.tangents = F(24, 1);
    finish_shading(primitive, {});
    EXPECT_TRUE(primitive.tangents.empty());
}

/// KHR_materials_anisotropy asks for NORMAL and TANGENT, or a normal texture: TEXCOORD_0 may be
/// absent.
TEST(MeshShading, GivenTangentsNeedNoTextureCoordinates) {
    MeshPrimitive primitive = square();
    primitive.uvs[0].clear();
    for (int i = 0; i < 6; ++i)
        primitive.tangents.insert(primitive.tangents.end(), {0, 2, 0, 1});
    MaterialNeeds brushed;
    brushed.tangents = true;
    finish_shading(primitive, brushed);
    ASSERT_EQ(primitive.tangents.size(), 24U);
    EXPECT_EQ(vertex(primitive.tangents, 5, 4), (F{0, 1, 0, 1}));

    primitive.tangents[1] = NAN;
    finish_shading(primitive, brushed);
    EXPECT_TRUE(primitive.tangents.empty());  // there is nothing to make them of
}

TEST(MeshShading, BadTangentsAreMadeAnew) {  // C17
    MeshPrimitive primitive = square();
    for (int i = 0; i < 6; ++i)
        primitive.tangents.insert(primitive.tangents.end(), {0, 1, 0, 1});
    primitive.tangents[1] = NAN;
    finish_shading(primitive, normal_mapped());
    EXPECT_EQ(primitive.issues, issue_bit(MeshIssue::bad_tangents));
    EXPECT_NEAR(primitive.tangents[0], 1, 1e-6f);
}

TEST(MeshShading, MissingTangentsFollowTheTexture) {
    MeshPrimitive primitive = square();
    finish_shading(primitive, normal_mapped());
    ASSERT_EQ(primitive.tangents.size(), 24U);  // nothing had to be doubled
    EXPECT_EQ(primitive.indices, square().indices);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(primitive.tangents[4 * i], 1, 1e-6f);
}

/// KHR_texture_transform rotates the image on the surface, and so the tangents.
TEST(MeshShading, MissingTangentsFollowTheTextureTransform) {
    MeshPrimitive primitive = square();
    MaterialNeeds needs = normal_mapped();
    const float quarter_turn[6] = {0, 1, 0, -1, 0, 0};
    std::copy(quarter_turn, quarter_turn + 6, needs.normal_map.uv_from_mesh);
    finish_shading(primitive, needs);
    // u' = v, which falls towards +Y.
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(primitive.tangents[4 * i + 1], -1, 1e-6f);
}

/// Where a mirrored texture meets itself, vertices are duplicated with all attributes.
TEST(MeshShading, VerticesOnAMirrorSeamAreDoubled) {
    MeshPrimitive primitive = square();
    primitive.uvs[0] = {0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0};  // u runs back behind x = 1
    primitive.uvs[3] = {0, 0, 1, 10, 2, 20, 3, 30, 4, 40, 5, 50};
    primitive.colors.resize(24, 0.5f);
    finish_shading(primitive, normal_mapped());
    ASSERT_EQ(primitive.positions.size(), 8U * 3);
    EXPECT_EQ(primitive.normals.size(), 8U * 3);
    EXPECT_EQ(primitive.tangents.size(), 8U * 4);
    EXPECT_EQ(primitive.colors.size(), 8U * 4);
    EXPECT_EQ(primitive.uvs[0].size(), 8U * 2);
    const MeshPrimitive before = square();
    for (size_t corner = 0; corner < primitive.indices.size(); ++corner) {
        const uint32_t now = primitive.indices[corner];
        const uint32_t then = before.indices[corner];
        EXPECT_EQ(vertex(primitive.positions, now, 3), vertex(before.positions, then, 3));
        EXPECT_EQ(primitive.uvs[3][2 * now + 1], 10.0f * static_cast<float>(then));
        const float expected = corner < 6 ? 1.0f : -1.0f;
        EXPECT_NEAR(primitive.tangents[4 * now], expected, 1e-6f) << corner;
    }
}

TEST(MeshShading, FlatMeshesWithANormalMapGetNormalsOfTheirTriangles) {
    MeshPrimitive primitive = square(1);
    primitive.normals.clear();
    finish_shading(primitive, normal_mapped());
    ASSERT_EQ(primitive.positions.size(), primitive.indices.size() * 3);
    ASSERT_EQ(primitive.normals.size(), primitive.positions.size());
    const float half = std::sqrt(0.5f);
    for (size_t corner = 0; corner < primitive.indices.size(); ++corner) {
        const F normal = vertex(primitive.normals, primitive.indices[corner], 3);
        const F tangent = vertex(primitive.tangents, primitive.indices[corner], 4);
        EXPECT_NEAR(normal[0], corner < 6 ? 0 : -half, 1e-6f);
        EXPECT_NEAR(normal[2], corner < 6 ? 1 : half, 1e-6f);
        EXPECT_NEAR(tangent[0], corner < 6 ? 1 : half, 1e-6f);
    }
}

TEST(MeshShading, FlatMeshesWithoutANormalMapStayAsTheyAre) {
    MeshPrimitive primitive = square(1);
    primitive.normals.clear();
    finish_shading(primitive, {});
    EXPECT_TRUE(primitive.normals.empty());
    EXPECT_EQ(primitive.positions.size(), 18U);
}

}  // namespace
}  // namespace obscura::gltf
