// tests/surface/texture_test.cpp - texture look-ups against closed forms in double.
// SPDX-License-Identifier: Apache-2.0
#include "surface/texture.h"

#include "surface/texture_images.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include <array>
#include <limits>
#include <sys/mman.h>

namespace obscura {
namespace {

using namespace test;

constexpr uint32_t nearest_sampler(Wrap u, Wrap v) {
    return pack_sampler(u, v, true, true, MipMode::none, false);
}
TEST(Texture, NearestTakesTheTexelThatHoldsThePoint) {
    Pcg32 random(1);
    for_all_shapes([&](int width, int height, Wrap wrap_u, Wrap wrap_v) {
        Images images(2);
        const int32_t texture = images.add(width, height, nearest_sampler(wrap_u, wrap_v));
        for (int y = -3 * height; y < 4 * height; ++y) {
            for (int x = -3 * width; x < 4 * width; ++x) {
                const Vec2f uv{(static_cast<float>(x) + 0.02F + 0.96F * random.next_float()) /
                                   static_cast<float>(width),
                               (static_cast<float>(y) + 0.02F + 0.96F * random.next_float()) /
                                   static_cast<float>(height)};
                const Rgba8 expected = images.texel(texture, 0, x, y);
                const Rgba8 one =
                    widen(sample_texture_bilinear<float>(images.view(), texture, uv, 0.0F));
                ASSERT_LT(difference(one, expected), 1e-6) << x << ", " << y;
                ASSERT_LT(difference(lanes_bilinear(images, texture, uv, 0.0F), expected), 1e-6);
                const Vec3f any{random.next_float(), random.next_float(), random.next_float()};
                const Rgba8 stochastic =
                    widen(sample_texture_stochastic<float>(images.view(), texture, uv, 0.0F, any));
                ASSERT_LT(difference(stochastic, expected), 1e-6) << x << ", " << y;
            }
        }
    });
}

TEST(Texture, BilinearIsTheClosedForm) {
    Pcg32 random(3);
    for_all_shapes([&](int width, int height, Wrap wrap_u, Wrap wrap_v) {
        Images images(4);
        const int32_t texture = images.add(width, height, linear_sampler(wrap_u, wrap_v));
        for (int n = 0; n < 500; ++n) {
            const Vec2f uv{7.0F * random.next_float() - 3.0F, 7.0F * random.next_float() - 3.0F};
            const Rgba8 expected = images.bilinear(texture, 0, uv.x, uv.y);
            const Rgba8 one =
                widen(sample_texture_bilinear<float>(images.view(), texture, uv, 0.0F));
            ASSERT_LT(difference(one, expected), 5e-5) << uv.x << ", " << uv.y;
            ASSERT_LT(difference(lanes_bilinear(images, texture, uv, 0.0F), expected), 5e-5);
            const Rgba8 wide = widen(sample_texture_bilinear<double>(
                images.view(), texture, Vec2<double>{uv.x, uv.y}, 0.0));
            ASSERT_LT(difference(wide, expected), 1e-6);
        }
    });
}

TEST(Texture, FarCoordinatesWrapLikeNearOnes) {
    for_all_shapes([&](int width, int height, Wrap wrap_u, Wrap wrap_v) {
        Images images(5);
        const int32_t texture = images.add(width, height, nearest_sampler(wrap_u, wrap_v));
        for (const float far : {1000.4140625F, -2000.5859375F, 65536.4140625F, -65537.5859375F}) {
            const Vec2f uv{far, -far};
            const Rgba8 expected = images.nearest(texture, 0, uv.x, uv.y);
            const Rgba8 one =
                widen(sample_texture_bilinear<float>(images.view(), texture, uv, 0.0F));
            EXPECT_LT(difference(one, expected), 1e-6) << far;
            EXPECT_LT(difference(lanes_bilinear(images, texture, uv, 0.0F), expected), 1e-6);
        }
    });
}

TEST(Texture, NoCoordinateReadsOutsideOfTheTexture) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const std::array strange = {nan,
                                infinity,
                                -infinity,
                                1e30F,
                                -1e30F,
                                3e9F,
                                -3e9F,
                                1e-38F,
                                -1e-38F,
                                -1e-9F,
                                1.0F,
                                -1.0F,
                                2.0F,
                                0.0F,
                                -0.0F,
                                0.99999994F,
                                16777217.0F};
    Pcg32 random(6);
    for_all_shapes([&](int width, int height, Wrap wrap_u, Wrap wrap_v) {
        // Outside of the texture lie texels of 255: a texture of zeros must read as zero.
        std::vector<uint32_t> texels(static_cast<size_t>(width * height) + 2, 0U);
        texels.front() = texels.back() = 0xFFFFFFFFU;
        TextureRecord record;
        record.width = width;
        record.height = height;
        record.sampler = linear_sampler(wrap_u, wrap_v);
        record.level_offset[0] = 1;
        const TextureView view{texels.data(), &record};
        for (const float u : strange) {
            for (const float v : strange) {
                for (const float footprint : {0.0F, nan, infinity, 1e-3F}) {
                    const auto smooth = sample_texture_bilinear<float>(view, 0, {u, v}, footprint);
                    ASSERT_LT(difference(widen(smooth), {}), 1e-9) << u << ", " << v;
                    const Vec3f r{random.next_float(), random.next_float(), random.next_float()};
                    const auto one =
                        sample_texture_stochastic<float>(view, 0, {u, v}, footprint, r);
                    ASSERT_LT(difference(widen(one), {}), 1e-9) << u << ", " << v;
                    const auto many = sample_texture_stochastic<Lanes>(
                        view, LanesI(0), {u, v}, footprint, {r.x, r.y, r.z});
                    ASSERT_EQ(lane(many.rgb.x, 0), 0.0F) << u << ", " << v;
                    ASSERT_EQ(lane(many.alpha, lane_count - 1), 0.0F) << u << ", " << v;
                }
            }
        }
    });
}

TEST(Texture, SrgbCodesAreDecodedAndAlphaIsNot) {
    for (uint32_t code = 0; code < 256; ++code) {
        const uint32_t texel = code * 0x01010101U;
        const double linear = srgb_to_linear(code / 255.0);
        const Rgba8 encoded = widen(decode_texel<float>(texel, true));
        EXPECT_LT(difference(encoded, {linear, linear, linear, code / 255.0}), 1e-6);
        const Rgba8 plain = widen(decode_texel<double>(texel, false));
        EXPECT_LT(difference(plain, {code / 255.0, code / 255.0, code / 255.0, code / 255.0}),
                  1e-7);
    }
    const Rgba8 order = widen(decode_texel<float>(0xFF804020U, false));
    EXPECT_LT(difference(order, {32 / 255.0, 64 / 255.0, 128 / 255.0, 1.0}), 1e-6);
    // Lanes may hold both kinds.
    const Mask first = lane_numbers() == LanesI(0);
    const Rgba<Lanes> mixed = decode_texel<Lanes>(LanesU(0x80808080U), first);
    EXPECT_NEAR(lane(mixed.rgb.y, 0), srgb_to_linear(128 / 255.0), 1e-6);
    EXPECT_NEAR(lane(mixed.rgb.y, 1), 128 / 255.0, 1e-6);
    EXPECT_NEAR(lane(mixed.alpha, 0), 128 / 255.0, 1e-6);
}

/// Different textures, or one texture at points all inside or also at its edges.
TEST(Texture, LanesReadTheirOwnTexels) {
    Images images(7);
    for (int i = 0; i < lane_count; ++i) {
        const uint32_t srgb = i % 2 == 0 ? sampler_srgb : 0U;
        const Wrap wrap = all_wraps[i % 3];
        const MipMode mip = i % 4 == 3 ? MipMode::nearest : MipMode::none;
        images.add(3 + i, 20 - i, linear_sampler(wrap, wrap, mip) | srgb);
    }
    Pcg32 random(8);
    for (int n = 0; n < 200; ++n) {
        const float width = n % 3 == 0 ? 0.5F : 4.0F;
        const auto coordinate = [&](int) { return 0.5F + width * (random.next_float() - 0.5F); };
        const LanesI texture = n % 2 == 0 ? lane_numbers() : LanesI(n / 2 % lane_count);
        const Vec2<Lanes> uv{make_lanes(coordinate), make_lanes(coordinate)};
        const float footprint = 0.1F * random.next_float();
        const Rgba<Lanes> many =
            sample_texture_bilinear<Lanes>(images.view(), texture, uv, footprint);
        for (int i = 0; i < lane_count; ++i) {
            const Rgba<float> one = sample_texture_bilinear<float>(
                images.view(), lane(texture, i), {lane(uv.x, i), lane(uv.y, i)}, footprint);
            const Rgba<float> same{lane(many.rgb, i), lane(many.alpha, i)};
            ASSERT_LT(difference(widen(one), widen(same)), 2e-5) << "lane " << i;
        }
    }
}

TEST(Texture, MipModesChooseTheirLevel) {
    Images images(9);
    for (const auto& size : sizes) {
        for (const MipMode mode : {MipMode::none, MipMode::nearest}) {
            const uint32_t sampler =
                pack_sampler(Wrap::clamp, Wrap::clamp, true, true, mode, false);
            const int32_t texture = images.add(size[0], size[1], sampler);
            const TextureRecord& record = images.record(texture);
            for (double lod = -3.05; lod < 8; lod += 0.1) {
                const float footprint = footprint_of(record, lod);
                const int nearest =
                    std::clamp(static_cast<int>(std::floor(lod + 0.5)), 0, record.levels - 1);
                const int level = mode == MipMode::none ? 0 : nearest;
                const Vec2f uv{0.37F, 0.71F};
                const Rgba8 expected = images.nearest(texture, level, uv.x, uv.y);
                const Rgba8 got =
                    widen(sample_texture_bilinear<float>(images.view(), texture, uv, footprint));
                EXPECT_LT(difference(got, expected), 1e-6) << "lod " << lod;
                const Rgba8 lanes = lanes_bilinear(images, texture, uv, footprint);
                EXPECT_LT(difference(lanes, expected), 1e-6) << "lod " << lod;
            }
        }
    }
}

TEST(Texture, MagnificationAndMinificationHaveTheirOwnFilter) {
    Images images(10);
    const Vec2f uv{0.37F, 0.71F};
    for (const bool magnify_nearest : {false, true}) {
        const int32_t texture = images.add(8,
                                           8,
                                           pack_sampler(Wrap::repeat,
                                                        Wrap::repeat,
                                                        magnify_nearest,
                                                        !magnify_nearest,
                                                        MipMode::none,
                                                        false));
        const Rgba8 point = images.nearest(texture, 0, uv.x, uv.y);
        const Rgba8 smooth = images.bilinear(texture, 0, uv.x, uv.y);
        ASSERT_GT(difference(point, smooth), 0.01);
        for (const double lod : {-2.0, -0.1, 0.1, 2.0}) {
            const Rgba8 got = widen(sample_texture_bilinear<float>(
                images.view(), texture, uv, footprint_of(images.record(texture), lod)));
            const bool nearest = lod > 0 ? !magnify_nearest : magnify_nearest;
            EXPECT_LT(difference(got, nearest ? point : smooth), 1e-5) << lod;
        }
    }
}

/// Mean of stochastic look-ups, in lanes, against the expected value: 4 standard errors.
void expect_mean(
    const Images& images, int32_t texture, Vec2f uv, float footprint, const Rgba8& expected) {
    Pcg32 random(11);
    constexpr int rounds = 8192 / lane_count;
    double sum[4] = {};
    double squares[4] = {};
    for (int n = 0; n < rounds; ++n) {
        const auto number = [&](int) { return random.next_float(); };
        const Vec3<Lanes> numbers{make_lanes(number), make_lanes(number), make_lanes(number)};
        const Rgba<Lanes> many = sample_texture_stochastic<Lanes>(
            images.view(), LanesI(texture), {Lanes(uv.x), Lanes(uv.y)}, footprint, numbers);
        for (int i = 0; i < lane_count; ++i) {
            const Rgba8 one = widen(Rgba<float>{lane(many.rgb, i), lane(many.alpha, i)});
            for (int c = 0; c < 4; ++c) {
                sum[c] += one.channel[c];
                squares[c] += one.channel[c] * one.channel[c];
            }
        }
    }
    constexpr double count = rounds * lane_count;
    for (int c = 0; c < 4; ++c) {
        const double mean = sum[c] / count;
        const double variance = std::max(squares[c] / count - mean * mean, 0.0);
        EXPECT_NEAR(mean, expected.channel[c], 4 * std::sqrt(variance / count) + 1e-5)
            << uv.x << ", " << uv.y << " channel " << c;
    }
}

TEST(Texture, StochasticMeanIsBilinear) {
    Pcg32 random(12);
    for_all_shapes([&](int width, int height, Wrap wrap_u, Wrap wrap_v) {
        Images images(13);
        const int32_t texture =
            images.add(width, height, linear_sampler(wrap_u, wrap_v) | sampler_srgb);
        for (int n = 0; n < 3; ++n) {
            const Vec2f uv{3.0F * random.next_float() - 1.0F, 3.0F * random.next_float() - 1.0F};
            expect_mean(images, texture, uv, 0.0F, images.bilinear(texture, 0, uv.x, uv.y));
        }
    });
}

TEST(Texture, StochasticMeanIsTrilinear) {
    Pcg32 random(14);
    for (const auto& size : sizes) {
        Images images(15);
        const int32_t texture = images.add(
            size[0], size[1], linear_sampler(Wrap::repeat, Wrap::mirror, MipMode::linear));
        const TextureRecord& record = images.record(texture);
        for (const double lod : {-1.0, 0.25, 0.7, 1.5, 2.9, 9.0}) {
            const Vec2f uv{random.next_float(), random.next_float()};
            const double inside = std::clamp(lod, 0.0, record.levels - 1.0);
            const int level = std::min(static_cast<int>(inside), record.levels - 1);
            const int next = std::min(level + 1, record.levels - 1);
            const Rgba8 fine = images.bilinear(texture, level, uv.x, uv.y);
            const Rgba8 coarse = images.bilinear(texture, next, uv.x, uv.y);
            Rgba8 expected{};
            for (int c = 0; c < 4; ++c) {
                expected.channel[c] =
                    fine.channel[c] + (inside - level) * (coarse.channel[c] - fine.channel[c]);
            }
            expect_mean(images, texture, uv, footprint_of(record, lod), expected);
        }
    }
}

/// Address space for the largest arena, untouched pages of which cost nothing.
class HugeArena {
public:
    static constexpr size_t texel_count = (size_t{1} << 31) - 1;

    HugeArena() {
        void* memory = mmap(nullptr,
                            texel_count * 4,
                            PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE,
                            -1,
                            0);
        if (memory != MAP_FAILED) texels_ = static_cast<uint32_t*>(memory);
    }
    ~HugeArena() {
        if (texels_ != nullptr) munmap(texels_, texel_count * 4);
    }
    HugeArena(const HugeArena&) = delete;
    HugeArena& operator=(const HugeArena&) = delete;

    uint32_t* texels() const { return texels_; }

private:
    uint32_t* texels_ = nullptr;
};

void expect_texel(const HugeArena& arena, const TextureRecord& record, size_t x, size_t y) {
    const size_t at =
        static_cast<size_t>(record.level_offset[0]) + y * static_cast<size_t>(record.width) + x;
    ASSERT_LT(at, HugeArena::texel_count);
    arena.texels()[at] = 0xFF804020U;
    const TextureView view{arena.texels(), &record};
    const Vec2f uv{(static_cast<float>(x) + 0.5F) / static_cast<float>(record.width),
                   (static_cast<float>(y) + 0.5F) / static_cast<float>(record.height)};
    const Rgba8 expected{32 / 255.0, 64 / 255.0, 128 / 255.0, 1.0};
    const Rgba8 one = widen(sample_texture_bilinear<float>(view, 0, uv, 0.0F));
    EXPECT_LT(difference(one, expected), 1e-6) << x << ", " << y;
    const auto many =
        sample_texture_bilinear<Lanes>(view, LanesI(0), {Lanes(uv.x), Lanes(uv.y)}, Lanes(0.0F));
    EXPECT_LT(difference(widen(Rgba<float>{lane(many.rgb, 1), lane(many.alpha, 1)}), expected),
              1e-6)
        << x << ", " << y;
    arena.texels()[at] = 0U;
}

TEST(Texture, TheLargestTextureIsReadToItsLastTexel) {
    const HugeArena arena;
    if (arena.texels() == nullptr) GTEST_SKIP() << "no 8 GB of address space";
    TextureRecord record;
    record.width = 65536;
    record.height = 32767;
    record.levels = max_mip_levels;
    record.sampler = nearest_sampler(Wrap::repeat, Wrap::clamp);
    expect_texel(arena, record, 0, 0);
    expect_texel(arena, record, 65535, 0);
    expect_texel(arena, record, 65535, 32766);
    expect_texel(arena, record, 12345, 32100);
    record.width = 300;
    record.height = 200;
    record.level_offset[0] = static_cast<int32_t>(HugeArena::texel_count) - 300 * 200;
    expect_texel(arena, record, 0, 0);
    expect_texel(arena, record, 299, 199);
}

}  // namespace
}  // namespace obscura
