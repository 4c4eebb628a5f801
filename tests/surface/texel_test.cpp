// tests/surface/texel_test.cpp - 16-bit texels, and single texels drawn from a footprint.
// SPDX-License-Identifier: Apache-2.0
#include "surface/texture.h"
#include "surface/texture_images.h"

#include <gtest/gtest.h>

#include <array>

namespace obscura {
namespace {

using namespace test;

TEST(Texel, EveryWideCodeIsDecoded) {
    double last = -1;
    for (uint32_t code = 0; code < 65536; ++code) {
        const uint32_t high = (code >> 8) * 0x01010101U;
        const uint32_t low = (code & 255U) * 0x01010101U;
        const double value = code / 65535.0;
        const double linear = srgb_to_linear(value);
        const Rgba8 plain = widen(decode_wide_texel<float>(high, low, false));
        ASSERT_LT(difference(plain, {value, value, value, value}), 1e-7) << code;
        const Rgba8 encoded = widen(decode_wide_texel<float>(high, low, true));
        ASSERT_LT(difference(encoded, {linear, linear, linear, value}), 7e-6) << code;
        ASSERT_GT(encoded.channel[0], last) << code;
        last = encoded.channel[0];
    }
}

TEST(Texel, WideOnesAreReadBesideOthers) {
    Pcg32 random(31);
    for_all_shapes([&](int width, int height, Wrap wrap_u, Wrap wrap_v) {
        Images images(32);
        const uint32_t sampler = linear_sampler(wrap_u, wrap_v);
        const std::array textures = {images.add(width, height, sampler),
                                     images.add_wide(width, height, sampler),
                                     images.add_wide(width, height, sampler | sampler_srgb)};
        for (const int32_t texture : textures) {
            for (int n = 0; n < 50; ++n) {
                const Vec2f uv{3 * random.next_float() - 1, 3 * random.next_float() - 1};
                const Rgba8 expected = images.bilinear(texture, 0, uv.x, uv.y);
                const Rgba8 one =
                    widen(sample_texture_bilinear<float>(images.view(), texture, uv, 0.0F));
                ASSERT_LT(difference(one, expected), 5e-5) << uv.x << ", " << uv.y;
                ASSERT_LT(difference(lanes_bilinear(images, texture, uv, 0.0F), expected), 5e-5);
                // For a footprint of a texel's size, the nearest one is drawn.
                const Rgba8 nearest = images.nearest(texture, 0, uv.x, uv.y);
                const Rgba8 drawn = widen(sample_texture_stochastic<float>(
                    images.view(), texture, uv, 0.0F, {0.5F, 0.5F, 0.5F}));
                ASSERT_LT(difference(drawn, nearest), 7e-6) << uv.x << ", " << uv.y;
            }
        }
    });
}

/// Each texel of level 0 must be drawn as often as the footprint covers it.
TEST(Texel, SingleTexelsAreDrawnFromTheWholeFootprint) {
    constexpr int drawn_side = 64;
    Pcg32 random(33);
    for (const auto& size : sizes) {
        for (const Wrap wrap : all_wraps) {
            Images images(34);
            const int32_t texture =
                images.add(size[0], size[1], linear_sampler(wrap, wrap, MipMode::linear));
            const TextureRecord& record = images.record(texture);
            for (const double lod : {-1.0, 0.3, 1.5, 4.0}) {
                const Vec2f uv{random.next_float(), random.next_float()};
                const float footprint = footprint_of(record, lod);
                const double side = std::max(std::exp2(lod), 1.0);
                const TextureInfo<float> info = texture_info<float>(images.view(), texture);
                Rgba8 mean{}, expected{};
                for (int i = 0; i < drawn_side * drawn_side; ++i) {
                    const double x = (i % drawn_side + 0.5) / drawn_side;
                    const double y = (i / drawn_side + 0.5) / drawn_side;  // NOLINT: whole rows
                    const Vec3f u{static_cast<float>(x), static_cast<float>(y), 0.5F};
                    const int32_t number = stochastic_single_texel<float>(info, uv, footprint, u);
                    const Rgba8 texel = widen(read_texel<float>(images.view(), number, 0, false));
                    const Rgba8 truth = images.nearest(
                        texture,
                        0,
                        static_cast<double>(uv.x) + (x - 0.5) * side / record.width,
                        static_cast<double>(uv.y) + (y - 0.5) * side / record.height);
                    for (int c = 0; c < 4; ++c) {
                        mean.channel[c] += texel.channel[c] / (drawn_side * drawn_side);
                        expected.channel[c] += truth.channel[c] / (drawn_side * drawn_side);
                    }
                }
                EXPECT_LT(difference(mean, expected), 0.02)
                    << size[0] << "x" << size[1] << " lod " << lod;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
