// tests/accel/alpha_filter_test.cpp - alpha MASK cuts where it should, BLEND in proportion.
// SPDX-License-Identifier: Apache-2.0
#include "accel/alpha_filter.h"

#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using namespace test;

constexpr int blend_rays = 100000 / thorough;

Material see_through(MaterialFlag mode, float alpha, float cutoff = 0.5F) {
    Material m;
    m.flags = mode | material_double_sided;
    m.base_color[3] = alpha;
    m.alpha_cutoff = cutoff;
    return m;
}

/// Squares of one material at heights 0, 1, ..., seen from above.
Scene sheets(const Material& material, int count = 1) {
    SceneBuilder builder;
    const int32_t index = builder.material(material);
    for (int i = 0; i < count; ++i)
        builder.quad({-1, -1, static_cast<float>(i)}, {2, 0, 0}, {0, 2, 0}, index);
    return builder.take();
}

/// Gives every quad the texture coordinates (0,0) (1,0) (1,1) (0,1) and the texels, in one line.
void add_texture(Scene& scene, const std::vector<uint32_t>& texels) {
    TextureRecord record;
    record.width = static_cast<int32_t>(texels.size());
    record.sampler = pack_sampler(Wrap::clamp, Wrap::clamp, true, true, MipMode::none, false);
    record.level_offset[0] = static_cast<int32_t>(scene.textures.texels.size());
    scene.textures.texels.insert(scene.textures.texels.end(), texels.begin(), texels.end());
    scene.textures.records.push_back(record);
    scene.materials[0].base_color_texture.texture = 0;
    for (size_t i = 0; i < scene.primitives.size(); ++i) {
        scene.primitives[i].uv_base[0] =
            static_cast<int32_t>(scene.attributes.size()) - 8 * static_cast<int32_t>(i);
        scene.attributes.insert(scene.attributes.end(), {0, 0, 1, 0, 1, 1, 0, 1});
    }
}

/// Rays straight down, spread over the square.
RayList rays_from_above(int count) {
    RayList rays;
    Pcg32 random(5);
    for (int i = 0; i < count; ++i) {
        const float x = between(random, -0.99F, 0.99F);
        rays.add({x, between(random, -0.99F, 0.99F), 50}, {0, 0, -1});
    }
    return rays;
}

/// Fraction of rays that hit; intersect and occluded must agree on every ray.
double fraction_of_hits(const BuiltScene& built, int count, uint32_t segment = 0) {
    RayList rays = rays_from_above(count);
    int hits = 0;
    for (const Coherence coherence : both_ways) {
        rays.intersect(built.accel, coherence, {false, false, segment});
        rays.occlude(built.accel, coherence, segment);
        hits = 0;
        for (int i = 0; i < count; ++i) {
            EXPECT_EQ(rays.occluded[static_cast<size_t>(i)], rays.hit(i) ? 1 : 0) << i;
            hits += rays.hit(i) ? 1 : 0;
        }
    }
    return static_cast<double>(hits) / count;
}

TEST(AlphaFilter, MaskHitsFromTheCutoffOn) {
    struct Case {
        float alpha, cutoff;
        double hits;
    };
    const Case cases[] = {{0.5F, 0.5F, 1},
                          {0.49F, 0.5F, 0},
                          {1, 0.99F, 1},
                          {0, 0.001F, 0},
                          {0, 0, 1},
                          {0.3F, 0.2F, 1},
                          {1, 1, 1},
                          {1, 1.5F, 0}};
    for (const Case& c : cases) {
        const BuiltScene built = build(sheets(see_through(material_alpha_mask, c.alpha, c.cutoff)));
        EXPECT_EQ(fraction_of_hits(built, 40), c.hits) << c.alpha << " cut at " << c.cutoff;
    }
}

TEST(AlphaFilter, MaskReadsTheTextureWhereTheRayHits) {
    Scene scene = sheets(see_through(material_alpha_mask, 1.0F));
    add_texture(scene, {0xFFFFFFFFU, 0x00FFFFFFU, 0x7FFFFFFFU, 0x80FFFFFFU});
    const BuiltScene built = build(std::move(scene));
    RayList rays = rays_from_above(2000 / thorough);
    for (const Coherence coherence : both_ways) {
        rays.intersect(built.accel, coherence);
        for (int i = 0; i < rays.count(); ++i) {
            const double u = 0.5 * rays.origin(i).x + 0.5;
            if (std::abs(u * 4 - std::round(u * 4)) < 1e-4) continue;  // between two texels
            const bool opaque = u < 0.25 || u > 0.75;
            ASSERT_EQ(rays.hit(i), opaque) << u;
        }
    }
}

TEST(AlphaFilter, TextureTransformAndVertexColorsCount) {
    Scene scene = sheets(see_through(material_alpha_mask, 1.0F));
    add_texture(scene, {0xFFFFFFFFU, 0x00FFFFFFU});
    const float turned[6] = {-1, 0, 1, 0, 1, 0};  // u' = 1 - u
    std::copy(turned, turned + 6, scene.materials[0].base_color_texture.uv_from_mesh);
    Scene colored = scene;
    const BuiltScene built = build(std::move(scene));
    RayList rays;
    rays.add({-0.5F, 0.1F, 9}, {0, 0, -1});
    rays.add({0.5F, 0.1F, 9}, {0, 0, -1});
    rays.intersect(built.accel, Coherence::coherent);
    EXPECT_FALSE(rays.hit(0));
    EXPECT_TRUE(rays.hit(1));

    // Alpha of the vertices falls from 1 at y = -1 to 0 at y = 1.
    colored.primitives[0].color_base = static_cast<int32_t>(colored.attributes.size());
    for (const float alpha : {1.0F, 1.0F, 0.0F, 0.0F})
        colored.attributes.insert(colored.attributes.end(), {1, 1, 1, alpha});
    const BuiltScene faded = build(std::move(colored));
    RayList two;
    two.add({0.5F, -0.1F, 9}, {0, 0, -1});
    two.add({0.5F, 0.1F, 9}, {0, 0, -1});
    two.intersect(faded.accel, Coherence::coherent);
    EXPECT_TRUE(two.hit(0));
    EXPECT_FALSE(two.hit(1));
}

TEST(AlphaFilter, BlendHitsInProportion) {
    for (const float alpha : {0.25F, 0.5F, 0.9F}) {
        const BuiltScene built = build(sheets(see_through(material_alpha_blend, alpha)));
        const double deviation = std::sqrt(alpha * (1 - alpha) / blend_rays);
        EXPECT_NEAR(fraction_of_hits(built, blend_rays), alpha, 3 * deviation);
    }
    EXPECT_EQ(fraction_of_hits(build(sheets(see_through(material_alpha_blend, 0))), 2000), 0);
    EXPECT_EQ(fraction_of_hits(build(sheets(see_through(material_alpha_blend, 1))), 2000), 1);
}

TEST(AlphaFilter, SheetsBehindEachOtherDecideOnTheirOwn) {
    const BuiltScene world = build(sheets(see_through(material_alpha_blend, 0.5F), 3));
    const BuiltScene placed = build(
        instanced(sheets(see_through(material_alpha_blend, 0.5F)),
                  {scaling(1, 1, 1), scaling(1, 1, 1, {0, 0, 1}), scaling(1, 1, 1, {0, 0, 2})}));
    const double deviation = std::sqrt(0.125 * 0.875 / blend_rays);
    EXPECT_NEAR(1 - fraction_of_hits(world, blend_rays), 0.125, 3 * deviation);
    EXPECT_NEAR(1 - fraction_of_hits(placed, blend_rays), 0.125, 3 * deviation);
}

TEST(AlphaFilter, SegmentsAreIndependentAndRepeatable) {
    const BuiltScene built = build(sheets(see_through(material_alpha_blend, 0.5F)));
    RayList rays = rays_from_above(blend_rays);
    const auto decide = [&](uint32_t segment) {
        rays.intersect(built.accel, Coherence::coherent, {false, false, segment});
        return rays.primitive;
    };
    const auto first = decide(0);
    EXPECT_EQ(first, decide(0));
    for (const uint32_t segment : {1U, 2U, 3U, 8U}) {
        const auto other = decide(segment);
        int same = 0;
        for (size_t i = 0; i < static_cast<size_t>(blend_rays); ++i)
            same += (first[i] < 0) == (other[i] < 0) ? 1 : 0;
        EXPECT_NEAR(static_cast<double>(same) / blend_rays, 0.5, 4 * std::sqrt(0.25 / blend_rays))
            << segment;
    }
}

TEST(AlphaFilter, FixedAlphaCutsBlendAtOneHalf) {
    for (const float alpha : {0.49F, 0.5F}) {
        const BuiltScene built = build(sheets(see_through(material_alpha_blend, alpha)));
        RayList rays = rays_from_above(200);
        rays.intersect(built.accel, Coherence::coherent, {true, true, 0});
        for (int i = 0; i < rays.count(); ++i)
            EXPECT_EQ(rays.hit(i), alpha >= 0.5F) << i;
    }
}

TEST(AlphaFilter, HiddenBacksDecideLikeFronts) {
    // Two single-sided sheets that face away, one of them see-through, above one that faces up.
    Material single = see_through(material_alpha_blend, 0.5F);
    single.flags &= ~static_cast<uint32_t>(material_double_sided);
    SceneBuilder builder;
    const int32_t index = builder.material(single);
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, index);
    builder.quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, index);
    builder.quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, index);
    const BuiltScene built = build(builder.take());
    RayList rays = rays_from_above(blend_rays);
    rays.intersect(built.accel, Coherence::coherent, {true, false, 0});
    int hits = 0;
    for (int i = 0; i < blend_rays; ++i) {
        if (!rays.hit(i)) continue;
        ++hits;
        ASSERT_EQ(rays.primitive[static_cast<size_t>(i)], 0);
    }
    EXPECT_NEAR(static_cast<double>(hits) / blend_rays, 0.5, 3 * std::sqrt(0.25 / blend_rays));
}

bool needs_filter(const Scene& scene) {
    return needs_alpha_filter(scene, scene.primitives[0], find_materials_with_holes(scene));
}

TEST(AlphaFilter, OpaqueSurfacesNeedNone) {
    Material opaque = see_through(material_alpha_blend, 0.3F);
    opaque.flags = 0;
    EXPECT_FALSE(needs_filter(sheets(opaque))) << "alphaMode OPAQUE ignores alpha";
    for (const MaterialFlag mode : {material_alpha_mask, material_alpha_blend}) {
        EXPECT_FALSE(needs_filter(sheets(see_through(mode, 1.0F))));
        EXPECT_EQ(needs_filter(sheets(see_through(mode, 0.9F))), mode == material_alpha_blend);
        EXPECT_TRUE(needs_filter(sheets(see_through(mode, 0.4F))));
        Scene textured = sheets(see_through(mode, 1.0F));
        add_texture(textured, {0xFF123456U, 0xFF000000U});
        EXPECT_FALSE(needs_filter(textured)) << "a texture without any transparent texel";
        textured.textures.texels.back() = 0xFE000000U;
        EXPECT_EQ(needs_filter(textured), mode == material_alpha_blend) << "above the cut-off";
        textured.textures.texels.back() = 0x40000000U;
        EXPECT_TRUE(needs_filter(textured));
        Scene colored = sheets(see_through(mode, 1.0F));
        colored.primitives[0].color_base = 0;
        colored.attributes.assign(16, 1.0F);
        EXPECT_TRUE(needs_filter(colored));
    }
    EXPECT_TRUE(needs_filter(sheets(see_through(material_alpha_mask, 1.0F, 1.5F))));
}

}  // namespace
}  // namespace obscura
