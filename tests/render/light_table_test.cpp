// tests/render/light_table_test.cpp - the lights of a scene and how often each is chosen.
// SPDX-License-Identifier: Apache-2.0
#include "render/light_table.h"

#include <gtest/gtest.h>

#include "support/arena_images.h"
#include "support/scene_builder.h"
#include <numeric>

namespace obscura::test {
namespace {

Material lamp(float radiance) {
    Material m;
    std::fill_n(m.emission, 3, radiance);
    return m;
}

PunctualLight bulb(PunctualType type, float intensity) {
    PunctualLight light;
    light.type = static_cast<int32_t>(type);
    std::fill_n(light.intensity, 3, intensity);
    return light;
}

EnvironmentTable sky(float radiance,
                     EnvironmentSampling sampling = EnvironmentSampling::compensated) {
    const ImageRgb32f image = *constant_environment(radiance);
    return EnvironmentTable::create(
               {image.width, image.height, image.pixels.data()}, 1, 0, sampling)
        .value();
}

TEST(LightTable, CoatIsItsFactorTimesTheMeanOfItsTexture) {
    Scene scene;
    Material material;
    EXPECT_EQ(mean_coat(scene, material), 0);
    material.layers = 0;
    scene.layers.resize(1);
    scene.layers[0].clearcoat = 0.5F;
    EXPECT_EQ(mean_coat(scene, material), 0.5F);
    scene.layers[0].clearcoat_texture.texture = 0;
    TextureRecord record;
    record.width = 2;
    record.levels = 2;
    record.level_offset[1] = 2;
    scene.textures.records = {record};
    scene.textures.texels = {0xFF0000FFU, 0xFF000001U, 0xFF000080U};
    EXPECT_FLOAT_EQ(mean_coat(scene, material), 0.5F * 128 / 255);
}

/// Sum of `count` probabilities.
double chosen(const LightTable& table, size_t first, size_t count) {
    const auto begin = table.select_pdf.begin() + static_cast<std::ptrdiff_t>(first);
    return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0);
}

void expect_whole(const LightTable& table) {
    EXPECT_NEAR(chosen(table, 0, table.select_pdf.size()), 1.0, 1e-6);
    for (size_t i = 0; i < table.triangles.size(); ++i) {
        const TriangleLight& record = table.triangles[i];
        const float select = table.select_pdf[table.punctual.size() + i];
        EXPECT_NEAR(record.pdf_area * record.area, select, 1e-6f * select) << "triangle " << i;
    }
}

/// A square of side `side` at height y that shows its front downwards.
void add_lamp(SceneBuilder& builder, float y, float side, const Material& m) {
    builder.quad({0, y, 0}, {side, 0, 0}, {0, 0, side}, builder.material(m));
}

TEST(LightTable, ProbabilitiesSumToOneOverAllKinds) {
    SceneBuilder builder;
    add_lamp(builder, 2, 1, lamp(3));
    add_lamp(builder, 3, 0.5f, lamp(7));
    Scene scene = builder.take();
    scene.lights = {bulb(PunctualType::point, 2),
                    bulb(PunctualType::spot, 5),
                    bulb(PunctualType::directional, 1)};
    const EnvironmentTable environment = sky(0.5f);
    const LightTable table = make_light_table(scene, &environment);
    ASSERT_EQ(table.triangles.size(), 4U);
    ASSERT_EQ(table.select_pdf.size(), 3U + 4U + 1U);
    expect_whole(table);
    EXPECT_EQ(table.environment_select, table.select_pdf.back());
    const LightView view = table.view();
    EXPECT_EQ(view.count, 8);
    EXPECT_EQ(view.punctual_count, 3);
    EXPECT_EQ(view.triangle_count, 4);
}

TEST(LightTable, WithoutLightsThereIsNothingToChoose) {
    Scene scene = SceneBuilder().take();
    const EnvironmentTable black = sky(0);
    for (const EnvironmentTable* environment :
         {static_cast<const EnvironmentTable*>(nullptr), &black}) {
        const LightTable table = make_light_table(scene, environment);
        EXPECT_EQ(table.view().count, 0);
        EXPECT_EQ(table.environment_select, 0.0f);
    }
}

TEST(LightTable, TwiceThePowerIsTwiceTheProbability) {
    for (const PunctualType type :
         {PunctualType::point, PunctualType::spot, PunctualType::directional}) {
        Scene scene = SceneBuilder().take();
        scene.lights = {bulb(type, 3), bulb(type, 6)};
        const LightTable table = make_light_table(scene, nullptr);
        ASSERT_EQ(table.select_pdf.size(), 2U);
        EXPECT_NEAR(table.select_pdf[1], 2 * table.select_pdf[0], 1e-5f);
    }
    Material both = lamp(2);
    both.flags = material_double_sided;
    SceneBuilder builder;
    add_lamp(builder, 1, 1, lamp(2));
    add_lamp(builder, 2, 1, lamp(4));                // twice the radiance
    add_lamp(builder, 3, std::sqrt(2.0f), lamp(2));  // twice the area
    add_lamp(builder, 4, 1, both);                   // twice the sides
    Scene scene = builder.take();
    const LightTable table = make_light_table(scene, nullptr);
    ASSERT_EQ(table.select_pdf.size(), 8U);
    for (size_t i = 1; i < 4; ++i)
        EXPECT_NEAR(chosen(table, 2 * i, 2), 2 * chosen(table, 0, 2), 1e-5) << "lamp " << i;
    expect_whole(table);
}

/// Probabilities of punctual lights, triangles and the environment, for these brightnesses.
std::vector<double> shares_of_kinds(float bulbs, float lamps, float around) {
    SceneBuilder builder;
    add_lamp(builder, 1, 1, lamp(lamps));
    Scene scene = builder.take();
    scene.lights = {bulb(PunctualType::point, bulbs)};
    const EnvironmentTable environment = sky(around);
    const LightTable table = make_light_table(scene, &environment);
    expect_whole(table);
    return {chosen(table, 0, 1), chosen(table, 1, 2), chosen(table, 3, 1)};
}

TEST(LightTable, DimPunctualLightsKeepTheirFloor) {
    // They are raised to a fifth before all are scaled to sum to 1; BSDF sampling cannot find them.
    for (int bright = 0; bright < 3; ++bright) {
        float brightness[3] = {1e-3f, 1e-3f, 1e-3f};
        brightness[bright] = 1e4f;
        const std::vector<double> shares =
            shares_of_kinds(brightness[0], brightness[1], brightness[2]);
        const double punctual = bright == 0 ? 1.0 : 0.2 / 1.2;
        for (int kind = 0; kind < 3; ++kind) {
            const double others = kind == bright ? 1.0 - punctual : 0.0;
            const double expected = kind == 0 ? punctual : others;
            EXPECT_NEAR(shares[static_cast<size_t>(kind)], expected, 1e-3) << bright << kind;
        }
    }
}

TEST(LightTable, HalfOfAnEnvironmentThatBsdfSamplingFindsCounts) {
    SceneBuilder builder;
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, builder.material({}));
    Scene scene = builder.take();
    // A sun that brings as much light as an even sky of radiance 3.
    scene.lights = {bulb(PunctualType::directional, 4 * pi_f * 3)};
    const EnvironmentTable found = sky(3);
    EXPECT_NEAR(make_light_table(scene, &found).environment_select, 1.0 / 3, 1e-3);
    const EnvironmentTable alone = sky(3, EnvironmentSampling::by_radiance);
    EXPECT_NEAR(make_light_table(scene, &alone).environment_select, 0.5, 1e-3);
}

TEST(LightTable, DimLampsAreRaisedInProportionUpToAFifth) {
    const double faint = shares_of_kinds(1.0f, 1e-5f, 1.0f)[1];
    const double fainter = shares_of_kinds(1.0f, 0.5e-5f, 1.0f)[1];
    EXPECT_NEAR(faint / fainter, 2.0, 0.1);
    const double dim = shares_of_kinds(1.0f, 3e-2f, 1.0f)[1];
    EXPECT_GT(dim, 0.1);
    EXPECT_LT(dim, 0.2);
}

constexpr int image_side = 64;

/// A texture whose texels are white from column `first_white` on and black before, with its mips.
int32_t add_image(Scene& scene, int first_white) {
    TextureArena& arena = scene.textures;
    TextureRecord record;
    record.width = record.height = image_side;
    record.levels = mip_level_count(image_side, image_side);
    record.sampler = pack_sampler(Wrap::clamp, Wrap::clamp, false, false, MipMode::linear, true);
    size_t at = arena.texels.size();
    for (int level = 0; level < record.levels; ++level) {
        record.level_offset[level] = static_cast<int32_t>(at);
        at += static_cast<size_t>(image_side >> level) * static_cast<size_t>(image_side >> level);
    }
    arena.texels.resize(at);
    uint32_t* const base = &arena.texels[static_cast<size_t>(record.level_offset[0])];
    for (int i = 0; i < image_side * image_side; ++i)
        base[i] = i % image_side >= first_white ? 0xFFFFFFFFU : 0xFF000000U;
    build_mip_chain(base, image_side, image_side, true);
    arena.records.push_back(record);
    return static_cast<int32_t>(arena.records.size()) - 1;
}

/// Gives a square of SceneBuilder the texture coordinates of the unit square.
void add_uv(Scene& scene, size_t primitive) {
    Primitive& p = scene.primitives[primitive];
    const uint32_t first = scene.indices[3 * static_cast<size_t>(p.first_triangle)];
    p.uv_base[0] = static_cast<int32_t>(scene.attributes.size()) - 2 * static_cast<int32_t>(first);
    scene.attributes.insert(scene.attributes.end(), {0, 0, 1, 0, 1, 1, 0, 1});
}

TEST(LightTable, AHalfBlackTextureHalvesThePower) {
    SceneBuilder builder;
    const int first_white[] = {0, image_side / 2, image_side};
    for (const int column : first_white) {
        Material m = lamp(5);
        m.emissive_texture.texture = add_image(builder.scene(), column);
        add_lamp(builder, 1 + static_cast<float>(column), 1, m);
    }
    Scene scene = builder.take();
    for (size_t i = 0; i < 3; ++i)
        add_uv(scene, i);
    const LightTable table = make_light_table(scene, nullptr);
    ASSERT_EQ(table.select_pdf.size(), 6U);
    const double white = chosen(table, 0, 2);
    EXPECT_NEAR(chosen(table, 2, 2), 0.5 * white, 0.02 * white);
    EXPECT_GT(chosen(table, 4, 2), 0.0) << "black ones keep a little";
    EXPECT_LT(chosen(table, 4, 2), 0.01 * white);
    // The white half lies in one triangle of the square for three quarters.
    EXPECT_NEAR(table.select_pdf[2], 3 * table.select_pdf[3], 0.1f * table.select_pdf[2]);
    expect_whole(table);
}

TEST(LightTable, AlphaTakesItsShareOfThePower) {
    const auto with_alpha = [](uint32_t mode, float alpha) {
        Material m = lamp(5);
        m.flags |= mode;
        m.base_color[3] = alpha;
        return m;
    };
    SceneBuilder builder;
    const Material cases[] = {lamp(5),
                              with_alpha(material_alpha_blend, 0.25f),
                              with_alpha(material_alpha_blend, 1),
                              with_alpha(material_alpha_mask, 0.5f),
                              with_alpha(material_alpha_mask, 0.49f)};
    for (size_t i = 0; i < std::size(cases); ++i)
        add_lamp(builder, 1 + static_cast<float>(i), 1, cases[i]);
    Scene scene = builder.take();
    const LightTable table = make_light_table(scene, nullptr);
    ASSERT_EQ(table.select_pdf.size(), 10U);
    const double whole = chosen(table, 0, 2);
    const double shares[] = {1, 0.25, 1, 1, 0};
    for (size_t i = 0; i < 5; ++i) {
        EXPECT_NEAR(chosen(table, 2 * i, 2), shares[i] * whole, 1e-5 * whole) << i;
        EXPECT_EQ(table.triangles[2 * i].alpha >= 0, shares[i] < 1) << i;
    }
    EXPECT_EQ(table.alphas.size(), 4U) << "what is opaque throughout has none";
    expect_whole(table);
}

TEST(LightTable, AlphaOfATextureAndOfVertices) {
    SceneBuilder builder;
    TextureArena& arena = builder.scene().textures;
    const uint32_t sharp =
        pack_sampler(Wrap::clamp, Wrap::clamp, true, true, MipMode::nearest, false);
    // Clear for u below a quarter, and in all of the second one.
    const int32_t images[] = {
        test::add_image(arena, 8, sharp, [](int x, int) { return x < 2 ? 0U : 0xFF000000U; }),
        test::add_image(arena, 8, sharp, [](int, int) { return 0U; })};
    for (const int32_t image : images) {
        Material m = lamp(5);
        m.flags |= material_alpha_mask;
        m.base_color_texture.texture = image;
        add_lamp(builder, 1 + static_cast<float>(image), 1, m);
    }
    Material faded = lamp(5);
    faded.flags |= material_alpha_blend;
    add_lamp(builder, 4, 1, faded);
    add_lamp(builder, 5, 1, lamp(5));
    Scene scene = builder.take();
    add_uv(scene, 0);
    add_uv(scene, 1);
    Primitive& p = scene.primitives[2];
    p.color_base = static_cast<int32_t>(scene.attributes.size()) - 4 * 8;
    for (const float alpha : {0.2f, 0.8f, 0.8f, 0.2f})
        scene.attributes.insert(scene.attributes.end(), {1, 1, 1, alpha});
    const LightTable table = make_light_table(scene, nullptr);
    const double whole = chosen(table, 6, 2);
    EXPECT_NEAR(chosen(table, 0, 2), 0.75 * whole, 0.04 * whole);
    EXPECT_GT(chosen(table, 2, 2), 0.0) << "the look-ups may have missed something";
    EXPECT_LT(chosen(table, 2, 2), 0.01 * whole);
    EXPECT_NEAR(chosen(table, 4, 2), 0.5 * whole, 0.02 * whole);
    expect_whole(table);
}

/// A dark and a glowing square as one mesh, placed thrice: as is, doubled and moved, mirrored.
Scene placed_thrice() {
    SceneBuilder builder;
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, builder.material({}));
    add_lamp(builder, 1, 1, lamp(2));
    Scene scene = builder.take();
    scene.world_primitive_count = 0;
    scene.meshes = {{0, 2}};
    scene.instances.resize(3);
    for (int axis = 0; axis < 3; ++axis)
        scene.instances[1].world_from_object.m[axis][axis] = 2;
    scene.instances[1].world_from_object.m[0][3] = 10;
    scene.instances[2].world_from_object.m[0][0] = -1;
    scene.instances[2].mirrored = 1;
    return scene;
}

TEST(LightTable, EveryInstanceHasRecordsOfItsOwn) {
    Scene scene = placed_thrice();
    const LightTable table = make_light_table(scene, nullptr);
    ASSERT_EQ(table.triangles.size(), 6U);
    EXPECT_EQ(scene.primitives[0].light_base, -1) << "it does not glow";
    EXPECT_EQ(scene.primitives[1].light_base, 0);
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(scene.instances[static_cast<size_t>(i)].light_base, 2 * i);
    const float corner_x[] = {0, 10, 0};
    const float corner_y[] = {1, 2, 1};
    const float area[] = {0.5f, 2, 0.5f};
    for (size_t i = 0; i < 6; ++i) {
        const TriangleLight& record = table.triangles[i];
        EXPECT_EQ(record.p0[0], corner_x[i / 2]) << i;
        EXPECT_EQ(record.p0[1], corner_y[i / 2]) << i;
        EXPECT_NEAR(record.area, area[i / 2], 1e-6f) << i;
        const Vec3f front = cross(Vec3f{record.e1[0], record.e1[1], record.e1[2]},
                                  Vec3f{record.e2[0], record.e2[1], record.e2[2]});
        EXPECT_LT(front.y, 0.0f) << i << ": mirrors keep the front";
    }
    EXPECT_NEAR(chosen(table, 2, 2), 4 * chosen(table, 0, 2), 1e-5);
    EXPECT_NEAR(chosen(table, 4, 2), chosen(table, 0, 2), 1e-6);
    expect_whole(table);
}

TEST(LightTable, RecordsFollowTheTrianglesOfWorldPrimitives) {
    SceneBuilder builder;
    add_lamp(builder, 1, 1, lamp(0));
    add_lamp(builder, 2, 1, lamp(1));
    Material unlit = lamp(1);
    unlit.flags = material_unlit;
    add_lamp(builder, 3, 1, unlit);
    add_lamp(builder, 4, 0, lamp(1));  // without area
    add_lamp(builder, 5, 1, lamp(1));
    Scene scene = builder.take();
    const LightTable table = make_light_table(scene, nullptr);
    const int32_t bases[] = {-1, 0, -1, 2, 4};
    for (size_t i = 0; i < 5; ++i)
        EXPECT_EQ(scene.primitives[i].light_base, bases[i]) << i;
    ASSERT_EQ(table.triangles.size(), 6U);
    EXPECT_EQ(table.triangles[2].pdf_area, 0.0f);
    EXPECT_EQ(chosen(table, 2, 2), 0.0);
    EXPECT_EQ(table.triangles[4].p0[1], 5.0f);
    expect_whole(table);
}

}  // namespace
}  // namespace obscura::test
