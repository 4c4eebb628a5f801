// tests/gltf/splats_test.cpp - Gaussian splats from files: attributes, placements, faults.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/splats.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace obscura::gltf {
namespace {

using namespace test;

constexpr float harmonic_0 = 0.28209479F;

/// Splats whose attributes may be changed before they are written.
struct SplatFile {
    std::map<std::string, std::vector<float>> attributes = {
        {"POSITION", {1, 2, 3, -4, 0, 0}},
        {"ROTATION", {0, 0, 0, 1, 0, 0, 2, 2}},  // the second: a quarter round about z
        {"SCALE", {1, 2, 3, 0.5F, 1, 0.125F}},
        {"OPACITY", {0.75F, 1}},
        {"SH_DEGREE_0_COEF_0", {0, 1, -1, 2, 2, 2}}};
    json extension = {{"kernel", "ellipse"}, {"colorSpace", "lin_rec709_display"}};
    int mode = 0;
    json node = {{"mesh", 0}};

    void add_degree(int degree) {
        for (int n = 0; n <= 2 * degree; ++n) {
            attributes["SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(n)] = {
                0.5F, 0, 0, 0, static_cast<float>(n), -1};
        }
    }

    AssetBuilder builder() const {
        AssetBuilder out;
        json primitive = {{"mode", mode}};
        for (const auto& [name, values] : attributes) {
            const char* type = name == "OPACITY" ? "SCALAR" : name == "ROTATION" ? "VEC4" : "VEC3";
            const std::string prefix = name == "POSITION" ? "" : "KHR_gaussian_splatting:";
            primitive["attributes"][prefix + name] = out.add_accessor(type, 5126, values);
        }
        primitive["extensions"]["KHR_gaussian_splatting"] = extension;
        out.add_mesh(primitive);
        out.add_root(node);
        out.tree["extensionsUsed"] = {"KHR_gaussian_splatting"};
        return out;
    }
    Loaded load(bool lenient = false) const {
        LoadOptions options;
        options.lenient = lenient;
        return load_tree(builder().finished(), options);
    }
};

/// One splat as the scene has it.
struct Stored {
    Vec3d mean;
    Affined ball_from_world;
    double opacity;
};

Stored stored(const SplatField& field, size_t index) {
    const float* at = &field.blocks[index / splat_block * splat_block_floats + index % splat_block];
    const auto number = [&](size_t column) {
        return static_cast<double>(at[column * splat_block]);
    };
    Stored out{{number(0), number(1), number(2)}, {}, number(12)};
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c)
            out.ball_from_world.m[r][c] = number(3 + 3 * r + c);
    }
    return out;
}

/// The index of the splat whose mean is nearest to a position.
size_t index_at(const SplatField& field, const Vec3d& place) {
    size_t best = 0;
    for (size_t index = 0; index < field.boxes.size() * splat_block; ++index) {
        const Stored splat = stored(field, index);
        const bool nearer = length(splat.mean - place) < length(stored(field, best).mean - place);
        if (splat.opacity > 0 && (stored(field, best).opacity == 0 || nearer)) best = index;
    }
    return best;
}

Scene scene_of(const SplatFile& file) {
    Loaded loaded = file.load();
    EXPECT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    return loaded.scene ? std::move(*loaded.scene) : Scene{};
}

/// Distance from the centre in standard deviations.
double distance_in(const Stored& splat, const Vec3d& place) {
    return length(transform_vector(splat.ball_from_world, place - splat.mean));
}

TEST(Splats, HaveTheirAttributes) {
    const Scene scene = scene_of({});
    const SplatField& field = scene.splats;
    EXPECT_TRUE(scene.primitives.empty()) << "no points";
    ASSERT_EQ(field.groups.size(), 1U);
    EXPECT_EQ(field.groups[0].count, 2);
    EXPECT_TRUE(field.groups[0].linear);
    EXPECT_EQ(scene.info.splats_in_world, 2U);
    const Stored first = stored(field, index_at(field, {1, 2, 3}));
    EXPECT_EQ(first.opacity, 0.75);
    EXPECT_NEAR(distance_in(first, {2, 2, 3}), 1, 1e-6);
    EXPECT_NEAR(distance_in(first, {1, 4, 3}), 1, 1e-6);
    EXPECT_NEAR(distance_in(first, {1, 2, 6}), 1, 1e-6);
    const Stored second = stored(field, index_at(field, {-4, 0, 0}));
    EXPECT_NEAR(distance_in(second, {-4, 0.5, 0}), 1, 1e-6);
    EXPECT_NEAR(distance_in(second, {-3, 0, 0}), 1, 1e-6);
    EXPECT_NEAR(distance_in(second, {-4, 0, 0.125}), 1, 1e-6);
    const Vec3f color = splat_color(field, index_at(field, {1, 2, 3}), {0, 0, 1});
    EXPECT_NEAR(color.x, 0.5, 1e-6);
    EXPECT_NEAR(color.y, 0.5F + harmonic_0, 1e-6);
    EXPECT_NEAR(color.z, 0.5F - harmonic_0, 1e-6);
    EXPECT_LE(scene.bounds.low.x, -4);
    EXPECT_GE(scene.bounds.high.z, 6);
}

TEST(Splats, BoxesHoldWhatIsDrawn) {
    const Scene scene = scene_of({});
    ASSERT_EQ(scene.splats.boxes.size(), 1U);
    const ShapeBox& box = scene.splats.boxes[0];
    EXPECT_LE(box.high.z, 3 + 3 * 3 * 1.02);
    EXPECT_GE(box.high.z, 3 + 3 * 3);
    EXPECT_LE(box.low.x, -4 - 3);
    EXPECT_GE(box.low.x, -4 - 3 * 1.02);
}

TEST(Splats, WithoutAColourSpaceOfTheirOwnAreDecoded) {
    SplatFile file;
    file.extension["colorSpace"] = "srgb_rec709_display";
    EXPECT_FALSE(scene_of(file).splats.groups[0].linear);
}

TEST(Splats, HaveTheSpaceOfTheirFileAlone) {
    LoadOptions options;
    options.from_rec709 = Matrix3{{{0.5, 0.3, 0.2}, {0.1, 0.8, 0.1}, {0, 0.2, 0.8}}};
    EXPECT_EQ(load_tree(SplatFile().builder().finished(), options).id(), "E-SPLAT-SPACE");
}

TEST(Splats, HarmonicsOfEveryDegree) {
    for (int degree = 1; degree <= 3; ++degree) {
        SplatFile file;
        for (int l = 1; l <= degree; ++l)
            file.add_degree(l);
        const Scene scene = scene_of(file);
        const SplatField& field = scene.splats;
        EXPECT_EQ(field.groups[0].degree, degree);
        // Along z only the functions of order 0 count: sqrt((2 l + 1) / (4 pi)).
        double sum = 0;
        double by_number = 0;
        for (int l = 1; l <= degree; ++l) {
            sum += std::sqrt((2 * l + 1) / (4 * pi_d));
            by_number += l * std::sqrt((2 * l + 1) / (4 * pi_d));
        }
        const Vec3f first = splat_color(field, index_at(field, {1, 2, 3}), {0, 0, 7});
        EXPECT_NEAR(first.x, 0.5 + 0.5 * sum, 2e-3);
        const Vec3f second = splat_color(field, index_at(field, {-4, 0, 0}), {0, 0, 1});
        EXPECT_NEAR(second.y, 0.5 + 2 * static_cast<double>(harmonic_0) + by_number, 2e-3);
        EXPECT_NEAR(second.z, std::max(0.0, 0.5 + 2 * static_cast<double>(harmonic_0) - sum), 2e-3)
            << "not below 0";
    }
}

/// Nodes rotate, stretch and mirror splats; placements share their colours.
TEST(Splats, FollowTheirNodes) {
    SplatFile file;
    file.add_degree(1);
    AssetBuilder builder = file.builder();
    builder.add_root({{"mesh", 0},
                      {"translation", {10, 0, 0}},
                      {"scale", {-1, 2, 1}},
                      {"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
    Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const SplatField& field = loaded.scene->splats;
    ASSERT_EQ(field.groups.size(), 2U);
    EXPECT_EQ(field.groups[1].node, 1);
    EXPECT_EQ(field.colors.size(), 6U);
    EXPECT_EQ(loaded.scene->info.splats_in_world, 4U);
    // (x, y, z) is at (10 - x, -z, 2 y).
    const size_t index = index_at(field, {9, -3, 4});
    const Stored splat = stored(field, index);
    EXPECT_NEAR(length(splat.mean - Vec3d{9, -3, 4}), 0, 1e-5);
    EXPECT_NEAR(distance_in(splat, {8, -3, 4}), 1, 1e-5);
    EXPECT_NEAR(distance_in(splat, {9, -6, 4}), 1, 1e-5);
    EXPECT_NEAR(distance_in(splat, {9, -3, 8}), 1, 1e-5);
    const Vec3f own = splat_color(field, index_at(field, {1, 2, 3}), {1, 2, -3});
    const Vec3f placed = splat_color(field, index, {-1, 3, 4});
    EXPECT_NEAR(placed.x, own.x, 1e-5);
}

TEST(Splats, NegativeScalesAreLogarithms) {
    SplatFile file;
    file.attributes["SCALE"] = {0, std::log(2.0F), std::log(3.0F), std::log(0.5F), 0, -2};
    Loaded loaded = file.load();
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("logarithms"));
    const SplatField& field = loaded.scene->splats;
    EXPECT_NEAR(distance_in(stored(field, index_at(field, {1, 2, 3})), {1, 4, 3}), 1, 1e-5);
}

TEST(Splats, FlatOnesKeepSomeThickness) {
    SplatFile file;
    file.attributes["SCALE"] = {1, 1, 0, 0, 0, 0};
    const Scene scene = scene_of(file);
    const Stored flat = stored(scene.splats, index_at(scene.splats, {1, 2, 3}));
    EXPECT_NEAR(distance_in(flat, {1, 2, 3.00001}), 1, 0.01);
    EXPECT_NEAR(distance_in(flat, {2, 2, 3}), 1, 1e-5);
    EXPECT_EQ(index_at(scene.splats, {-4, 0, 0}), index_at(scene.splats, {1, 2, 3}))
        << "one without any extent is not seen";
}

TEST(Splats, IntegersAreWhatTheExtensionAllows) {
    AssetBuilder builder = SplatFile{}.builder();
    json& attributes = builder.tree["meshes"][0]["primitives"][0]["attributes"];
    const auto set = [&](const char* name, int accessor, bool normalized) {
        if (normalized)
            builder.tree["accessors"][static_cast<size_t>(accessor)]["normalized"] = true;
        attributes[std::string("KHR_gaussian_splatting:") + name] = accessor;
    };
    set("SCALE", builder.add_accessor("VEC3", 5122, std::vector<int16_t>{1, 2, 3, 1, 1, 1}), false);
    set("OPACITY", builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{65535, 0}), true);
    set("ROTATION",
        builder.add_accessor("VEC4", 5122, std::vector<int16_t>{0, 0, 0, 32767, 0, 0, 0, 32767}),
        true);
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const SplatField& field = loaded.scene->splats;
    EXPECT_NEAR(distance_in(stored(field, index_at(field, {1, 2, 3})), {1, 4, 3}), 1, 1e-5);
}

TEST(Splats, MissingAttributesAreNamed) {
    for (const char* name : {"ROTATION", "SCALE", "OPACITY", "SH_DEGREE_0_COEF_0"}) {
        SplatFile file;
        file.attributes.erase(name);
        const Loaded loaded = file.load();
        EXPECT_EQ(loaded.code(), 65);
        EXPECT_EQ(loaded.id(), "E-MESH-SPLATS") << name;
        EXPECT_NE(loaded.text().find(name), std::string::npos) << loaded.text();
        EXPECT_TRUE(file.load(true).scene) << "leniently they are not drawn";
    }
    SplatFile file;
    file.add_degree(1);
    file.add_degree(2);
    file.attributes.erase("SH_DEGREE_1_COEF_2");
    EXPECT_EQ(file.load().id(), "E-MESH-SPLATS") << "degrees are whole";
    SplatFile no_degree_1;
    no_degree_1.add_degree(2);
    EXPECT_NE(no_degree_1.load().text().find("SH_DEGREE_1_COEF_0"), std::string::npos);
}

TEST(Splats, BadOnesAreFound) {
    const std::map<std::string, std::vector<float>> bad = {
        {"POSITION", {1, 2, 3, NAN, 0, 0}},
        {"ROTATION", {0, 0, 0, 1, 0, 0, 0, 0}},
        {"SCALE", {1, 2, 3, NAN, 1, 1}},
        {"OPACITY", {0.75F, 1.5F}},
        {"SH_DEGREE_0_COEF_0", {0, 1, -1, 2, NAN, 2}}};
    for (const auto& [name, values] : bad) {
        SplatFile file;
        file.attributes[name] = values;
        EXPECT_EQ(file.load().id(), "E-MESH-SPLATS") << name;
        EXPECT_NE(file.load().text().find("splat 1"), std::string::npos) << name;
        const Loaded lenient = file.load(true);
        ASSERT_TRUE(lenient.scene) << name;
        EXPECT_EQ(lenient.scene->info.splats_in_world, 1U) << name;
    }
    SplatFile opacity;
    opacity.attributes["OPACITY"] = {-0.1F, 1};
    EXPECT_EQ(opacity.load().code(), 65);
}

TEST(Splats, WrongTypesAndCountsAreRefused) {
    SplatFile file;
    file.attributes["OPACITY"] = {1, 1, 1};
    EXPECT_EQ(file.load().id(), "E-MESH-COUNT");
    AssetBuilder builder = SplatFile{}.builder();
    builder.tree["meshes"][0]["primitives"][0]["attributes"]["KHR_gaussian_splatting:SCALE"] =
        builder.tree["meshes"][0]["primitives"][0]["attributes"]["KHR_gaussian_splatting:ROTATION"];
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-MESH-ATTRIBUTE");
    SplatFile lines;
    lines.mode = 1;
    EXPECT_EQ(lines.load().id(), "E-MESH-SPLATS");
}

TEST(Splats, NodesMayMoveThemTooFar) {
    SplatFile file;
    file.node["scale"] = {1e19, 1e19, 1e19};
    EXPECT_EQ(file.load().id(), "E-NODE-RANGE");
    file.node["scale"] = {1, 0, 1};
    Loaded loaded = file.load();
    ASSERT_TRUE(loaded.scene);
    EXPECT_TRUE(loaded.scene->splats.empty());
    EXPECT_TRUE(loaded.warns("do not draw their Gaussian splats"));
}

TEST(Splats, CompressedOnesArePoints) {
    SplatFile file;
    file.extension["extensions"]["KHR_gaussian_splatting_compression_spz_2"] = json::object();
    Loaded loaded = file.load();
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("KHR_gaussian_splatting_compression_spz_2 is not supported"));
    EXPECT_TRUE(loaded.scene->splats.empty());
    EXPECT_EQ(loaded.scene->info.points_in_world, 2U);
}

/// 20,000 splats in 30,000 placements.
TEST(Splats, ThereIsALimit) {
    constexpr size_t count = 20000;
    constexpr size_t places = 30000;
    SplatFile file;
    file.attributes["POSITION"].assign(3 * count, 0);
    file.attributes["ROTATION"].assign(4 * count, 0.5F);
    file.attributes["SCALE"].assign(3 * count, 1);
    file.attributes["OPACITY"].assign(count, 1);
    file.attributes["SH_DEGREE_0_COEF_0"].assign(3 * count, 0);
    AssetBuilder builder = file.builder();
    builder.tree["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
    const int moves = builder.add_accessor("VEC3", 5126, std::vector<float>(3 * places, 0));
    builder.tree["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", moves}};
    const Loaded loaded = load_tree(builder.finished());
    EXPECT_EQ(loaded.code(), 77);
    EXPECT_EQ(loaded.id(), "E-LIMIT-SPLATS");
}

}  // namespace
}  // namespace obscura::gltf
