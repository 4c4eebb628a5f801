// tests/light/light_alpha_test.cpp - what emitters with alpha let out at a point.
// SPDX-License-Identifier: Apache-2.0
#include "light/light_alpha.h"

#include <gtest/gtest.h>

#include "support/arena_images.h"

namespace obscura::test {
namespace {

float alpha_at(const LightAlpha& light, const Vec2f& weight, const TextureArena& arena = {}) {
    const TextureView textures = view_of(arena);
    return light_alpha<float>(textures, spread<float>(light), weight);
}

TEST(LightAlpha, BlendInterpolatesAndKeepsWithinZeroAndOne) {
    LightAlpha light;
    light.factor[0] = 0.2F;
    light.factor[1] = 0.6F;
    light.factor[2] = 3.0F;
    EXPECT_FLOAT_EQ(alpha_at(light, {0, 0}), 0.2F);
    EXPECT_FLOAT_EQ(alpha_at(light, {1, 0}), 0.6F);
    EXPECT_FLOAT_EQ(alpha_at(light, {0.25F, 0.25F}), 1.0F) << "0.1 + 0.15 + 0.75";
    EXPECT_FLOAT_EQ(alpha_at(light, {0, 1}), 1.0F);
    light.factor[0] = -1;
    EXPECT_FLOAT_EQ(alpha_at(light, {0, 0}), 0.0F);
}

TEST(LightAlpha, MaskIsAllOrNothingFromTheCutOffOn) {
    LightAlpha light;
    light.is_mask = 1;
    light.cutoff = 0.5F;
    light.factor[0] = 0;
    EXPECT_EQ(alpha_at(light, {0.5F, 0}), 1.0F) << "just there";
    EXPECT_EQ(alpha_at(light, {0.49F, 0}), 0.0F);
    EXPECT_EQ(alpha_at(light, {0.5F, 0.2F}), 1.0F);
}

TEST(LightAlpha, TheTextureMultipliesTheFactor) {
    TextureArena arena;
    const uint32_t nearest =
        pack_sampler(Wrap::clamp, Wrap::clamp, true, true, MipMode::nearest, false);
    LightAlpha light;
    // Alpha 0 in the left half, 0.6 in the right one.
    light.texture =
        add_image(arena, 4, nearest, [](int x, int) { return x < 2 ? 0x00FFFFFFU : 0x99FFFFFFU; });
    std::fill_n(light.factor, 3, 0.5F);
    light.uv1[0] = 1;
    light.uv2[1] = 1;
    EXPECT_FLOAT_EQ(alpha_at(light, {0.9F, 0.05F}, arena), 0.3F);
    EXPECT_FLOAT_EQ(alpha_at(light, {0.1F, 0.8F}, arena), 0.0F);
    light.is_mask = 1;
    light.cutoff = 0.29F;
    EXPECT_EQ(alpha_at(light, {0.9F, 0.05F}, arena), 1.0F);
    light.cutoff = 0.31F;
    EXPECT_EQ(alpha_at(light, {0.9F, 0.05F}, arena), 0.0F);
}

}  // namespace
}  // namespace obscura::test
