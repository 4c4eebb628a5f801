// tests/gltf/mesh_shading_test.cpp - normals and tangents: given, broken, missing.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace obscura {
namespace {

/// Two triangles that share an edge: a square in the XY plane, folded up along x = 1 if asked.
MeshPart square(float fold = 0) {
    MeshPart part;
    part.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, fold, 2, 1, fold};
    part.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    part.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    part.uvs[0] = {0, 1, 1, 1, 1, 0, 0, 0, 2, 1, 2, 0};
    return part;
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
    MeshPart part = square();
    part.normals[2] = 5;
    finish_shading(part, {});
    EXPECT_EQ(vertex(part.normals, 0, 3), (F{0, 0, 1}));
    EXPECT_EQ(part.issues, 0U);
    EXPECT_TRUE(part.tangents.empty());
}

TEST(MeshShading, BadNormalsBecomeTheTrianglesOwn) {  // C17
    for (const float bad : {0.0f, NAN, INFINITY}) {
        MeshPart part = square(1);
        part.normals[2] = bad;   // vertex 0: in the flat triangles only
        part.normals[14] = bad;  // vertex 4: in a folded one only
        finish_shading(part, {});
        EXPECT_EQ(part.issues, issue_bit(MeshIssue::bad_normals));
        EXPECT_EQ(vertex(part.normals, 0, 3), (F{0, 0, 1}));
        const float half = std::sqrt(0.5f);
        EXPECT_NEAR(part.normals[12], -half, 1e-6f);
        EXPECT_NEAR(part.normals[14], half, 1e-6f);
    }
}

TEST(MeshShading, BadNormalsOfUnusedVerticesAreNobodysBusiness) {
    MeshPart part = square();
    part.positions.insert(part.positions.end(), {9, 9, 9});
    part.normals.insert(part.normals.end(), {0, 0, 0});
    finish_shading(part, {});
    EXPECT_EQ(part.issues, 0U);
}

TEST(MeshShading, DegenerateTrianglesGiveAUnitNormalToo) {
    MeshPart part;
    part.positions = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    part.normals = F(9, 0);
    part.indices = {0, 1, 2};
    finish_shading(part, {});
    EXPECT_EQ(vertex(part.normals, 1, 3), (F{0, 0, 1}));
}

TEST(MeshShading, GivenTangentsAreMadeUnit) {
    MeshPart part = square();
    for (int i = 0; i < 6; ++i)
        part.tangents.insert(part.tangents.end(), {3, 0, 0, -0.5f});
    finish_shading(part, normal_mapped());
    EXPECT_EQ(vertex(part.tangents, 3, 4), (F{1, 0, 0, -1}));
    EXPECT_EQ(part.positions.size(), 18U);
}

TEST(MeshShading, TangentsWithoutANormalMapAreDropped) {
    MeshPart part = square();
    part.tangents = F(24, 1);
    finish_shading(part, {});
    EXPECT_TRUE(part.tangents.empty());
}

/// KHR_materials_anisotropy asks for NORMAL and TANGENT, or a normal texture: TEXCOORD_0 may be
/// absent.
TEST(MeshShading, GivenTangentsNeedNoTextureCoordinates) {
    MeshPart part = square();
    part.uvs[0].clear();
    for (int i = 0; i < 6; ++i)
        part.tangents.insert(part.tangents.end(), {0, 2, 0, 1});
    MaterialNeeds brushed;
    brushed.tangents = true;
    finish_shading(part, brushed);
    ASSERT_EQ(part.tangents.size(), 24U);
    EXPECT_EQ(vertex(part.tangents, 5, 4), (F{0, 1, 0, 1}));

    part.tangents[1] = NAN;
    finish_shading(part, brushed);
    EXPECT_TRUE(part.tangents.empty());  // there is nothing to make them of
}

TEST(MeshShading, BadTangentsAreMadeAnew) {  // C17
    MeshPart part = square();
    for (int i = 0; i < 6; ++i)
        part.tangents.insert(part.tangents.end(), {0, 1, 0, 1});
    part.tangents[1] = NAN;
    finish_shading(part, normal_mapped());
    EXPECT_EQ(part.issues, issue_bit(MeshIssue::bad_tangents));
    EXPECT_NEAR(part.tangents[0], 1, 1e-6f);
}

TEST(MeshShading, MissingTangentsFollowTheTexture) {
    MeshPart part = square();
    finish_shading(part, normal_mapped());
    ASSERT_EQ(part.tangents.size(), 24U);  // nothing had to be doubled
    EXPECT_EQ(part.indices, square().indices);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(part.tangents[4 * i], 1, 1e-6f);
}

/// KHR_texture_transform turns the picture on the surface, and so the tangents.
TEST(MeshShading, MissingTangentsFollowTheTextureTransform) {
    MeshPart part = square();
    MaterialNeeds needs = normal_mapped();
    const float quarter_turn[6] = {0, 1, 0, -1, 0, 0};
    std::copy(quarter_turn, quarter_turn + 6, needs.normal_map.uv_from_mesh);
    finish_shading(part, needs);
    // u' = v, which falls towards +Y.
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(part.tangents[4 * i + 1], -1, 1e-6f);
}

/// Where a mirrored texture meets itself, vertices are doubled with all they have.
TEST(MeshShading, VerticesOnAMirrorSeamAreDoubled) {
    MeshPart part = square();
    part.uvs[0] = {0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0};  // u runs back behind x = 1
    part.uvs[3] = {0, 0, 1, 10, 2, 20, 3, 30, 4, 40, 5, 50};
    part.colors.resize(24, 0.5f);
    finish_shading(part, normal_mapped());
    ASSERT_EQ(part.positions.size(), 8U * 3);
    EXPECT_EQ(part.normals.size(), 8U * 3);
    EXPECT_EQ(part.tangents.size(), 8U * 4);
    EXPECT_EQ(part.colors.size(), 8U * 4);
    EXPECT_EQ(part.uvs[0].size(), 8U * 2);
    const MeshPart before = square();
    for (size_t corner = 0; corner < part.indices.size(); ++corner) {
        const uint32_t now = part.indices[corner];
        const uint32_t then = before.indices[corner];
        EXPECT_EQ(vertex(part.positions, now, 3), vertex(before.positions, then, 3));
        EXPECT_EQ(part.uvs[3][2 * now + 1], 10.0f * static_cast<float>(then));
        const float expected = corner < 6 ? 1.0f : -1.0f;
        EXPECT_NEAR(part.tangents[4 * now], expected, 1e-6f) << corner;
    }
}

TEST(MeshShading, FlatMeshesWithANormalMapGetNormalsOfTheirTriangles) {
    MeshPart part = square(1);
    part.normals.clear();
    finish_shading(part, normal_mapped());
    ASSERT_EQ(part.positions.size(), part.indices.size() * 3);
    ASSERT_EQ(part.normals.size(), part.positions.size());
    const float half = std::sqrt(0.5f);
    for (size_t corner = 0; corner < part.indices.size(); ++corner) {
        const F normal = vertex(part.normals, part.indices[corner], 3);
        const F tangent = vertex(part.tangents, part.indices[corner], 4);
        EXPECT_NEAR(normal[0], corner < 6 ? 0 : -half, 1e-6f);
        EXPECT_NEAR(normal[2], corner < 6 ? 1 : half, 1e-6f);
        EXPECT_NEAR(tangent[0], corner < 6 ? 1 : half, 1e-6f);
    }
}

TEST(MeshShading, FlatMeshesWithoutANormalMapStayAsTheyAre) {
    MeshPart part = square(1);
    part.normals.clear();
    finish_shading(part, {});
    EXPECT_TRUE(part.normals.empty());
    EXPECT_EQ(part.positions.size(), 18U);
}

}  // namespace
}  // namespace obscura
