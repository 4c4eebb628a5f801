// tests/scene/texture_arena_test.cpp - mip chains against means computed in double.
// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace obscura {
namespace {

using Image = std::vector<uint32_t>;

constexpr uint32_t rgba(uint32_t r, uint32_t g, uint32_t b, uint32_t a) {
    return r | g << 8 | b << 16 | a << 24;
}

double channel(uint32_t texel, int c) {
    return static_cast<double>(texel >> (8 * c) & 0xFFU);
}

double linear_of(double code) {
    const double x = code / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

double code_of(double linear) {
    return 255.0 *
           (linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

/// Overlap of [index, index + 1) * source / size with source texel i.
double overlap(int i, int index, int source, int size) {
    const double low = static_cast<double>(index) * source / size;
    const double high = static_cast<double>(index + 1) * source / size;
    return std::max(0.0, std::min(high, i + 1.0) - std::max(low, static_cast<double>(i)));
}

struct Source {
    const uint32_t* texels;
    int width, height;
    const uint32_t* low = nullptr;  ///< of 16-bit texels

    /// In 255ths.
    double code(int i, int c) const {
        if (low == nullptr) return channel(texels[i], c);
        return (channel(texels[i], c) * 256 + channel(low[i], c)) / 257;
    }
};

/// The four channels that texel (x, y) of the next level should have, before rounding.
std::array<double, 4> expected(const Source& from, int x, int y, bool srgb) {
    const int width = std::max(from.width / 2, 1), height = std::max(from.height / 2, 1);
    double plain[4] = {}, weighted[3] = {}, area = 0, alpha = 0;
    for (int j = 0; j < from.height; ++j) {
        for (int i = 0; i < from.width; ++i) {
            const double w = overlap(i, x, from.width, width) * overlap(j, y, from.height, height);
            const int at = j * from.width + i;
            const double a = from.code(at, 3);
            for (int c = 0; c < 3; ++c) {
                const double value = srgb ? linear_of(from.code(at, c)) : from.code(at, c);
                plain[c] += w * value;
                weighted[c] += w * a * value;
            }
            plain[3] += w * a;
            area += w;
            alpha += w * a;
        }
    }
    std::array<double, 4> mean{};
    for (size_t c = 0; c < 3; ++c) {
        const double value = srgb && alpha > 0 ? weighted[c] / alpha : plain[c] / area;
        mean[c] = srgb ? code_of(value) : value;
    }
    mean[3] = plain[3] / area;
    return mean;
}

Image noise(int width, int height, bool opaque) {
    Image image(mip_chain_texels(width, height), 0xDEADBEEFU);
    uint32_t state = 12345;
    const auto count = static_cast<size_t>(width) * static_cast<size_t>(height);
    for (size_t i = 0; i < count; ++i) {
        state = state * 1664525U + 1013904223U;
        image[i] = state ^ state >> 15;
        if (state % 7 == 0) image[i] &= 0x00FFFFFFU;
        if (opaque) image[i] |= 0xFF000000U;
    }
    return image;
}

/// Compares every level with the mean of the level before it.
void expect_exact_chain(int width, int height, bool srgb, bool opaque, bool wide = false) {
    Image image = noise(width, height, opaque);
    Image low = image;
    std::reverse(low.begin(), low.begin() + static_cast<ptrdiff_t>(width) * height);
    if (wide) {
        build_wide_mip_chain(image.data(), low.data(), width, height, srgb);
    } else {
        build_mip_chain(image.data(), width, height, srgb);
    }
    const double tolerance = wide ? 0.5 / 257 + 0.01 : 0.5 + 1e-3;
    Source from{image.data(), width, height, wide ? low.data() : nullptr};
    while (from.width > 1 || from.height > 1) {
        const auto count = static_cast<size_t>(from.width) * static_cast<size_t>(from.height);
        const int w = std::max(from.width / 2, 1), h = std::max(from.height / 2, 1);
        const Source to{from.texels + count, w, h, wide ? from.low + count : nullptr};
        for (int y = 0; y < h; ++y) {
            for (int x = 0; x < w; ++x) {
                const std::array<double, 4> mean = expected(from, x, y, srgb);
                for (int c = 0; c < 4; ++c) {
                    ASSERT_NEAR(to.code(y * w + x, c), mean[static_cast<size_t>(c)], tolerance)
                        << width << "x" << height << " level " << w << "x" << h << " at " << x
                        << "," << y << " channel " << c;
                }
            }
        }
        from = to;
    }
    EXPECT_EQ(from.texels + 1, image.data() + image.size()) << "the chain fills its texels";
}

TEST(TextureArena, CountsLevelsAndTexels) {
    EXPECT_EQ(mip_level_count(1, 1), 1);
    EXPECT_EQ(mip_level_count(2, 1), 2);
    EXPECT_EQ(mip_level_count(3, 7), 3);
    EXPECT_EQ(mip_level_count(65536, 1), max_mip_levels);
    EXPECT_EQ(mip_chain_texels(1, 1), 1U);
    EXPECT_EQ(mip_chain_texels(4, 4), 16U + 4U + 1U);
    EXPECT_EQ(mip_chain_texels(5, 3), 15U + 2U + 1U);
    EXPECT_EQ(mip_chain_texels(1, 8), 15U);
    EXPECT_EQ(mip_chain_texels(65536, 65536), 5726623061U) << "no overflow";
}

TEST(TextureArena, EveryLevelIsTheAreaWeightedMeanOfTheOneBefore) {
    constexpr int sizes[][2] = {
        {16, 16}, {8, 2}, {7, 5}, {6, 9}, {13, 8}, {1, 11}, {12, 1}, {3, 3}};
    for (const auto& size : sizes) {
        for (const bool srgb : {false, true}) {
            for (const bool opaque : {false, true}) {
                expect_exact_chain(size[0], size[1], srgb, opaque);
                expect_exact_chain(size[0], size[1], srgb, opaque, true);
            }
        }
    }
}

TEST(TextureArena, LargeImagesMadeByManyTasksAreTheSame) {
    constexpr int side = 512;
    Image image = noise(side, side, false);
    build_mip_chain(image.data(), side, side, true);
    for (int y = 0; y < side / 2; y += 17) {
        for (int x = 0; x < side / 2; x += 13) {
            Image block(5);
            for (int i = 0; i < 4; ++i) {
                block[static_cast<size_t>(i)] =
                    image[static_cast<size_t>((2 * y + i / 2) * side + 2 * x + i % 2)];
            }
            build_mip_chain(block.data(), 2, 2, true);
            EXPECT_EQ(image[static_cast<size_t>(side * side + y * side / 2 + x)], block[4]);
        }
    }
}

TEST(TextureArena, BlackAndWhiteAverageInLinearLight) {
    const uint32_t black = rgba(0, 0, 0, 255), white = rgba(255, 255, 255, 255);
    Image image = {black, white, white, black, 0};
    build_mip_chain(image.data(), 2, 2, true);
    EXPECT_EQ(image[4], rgba(188, 188, 188, 255));
    image[4] = 0;
    build_mip_chain(image.data(), 2, 2, false);
    EXPECT_EQ(image[4], rgba(128, 128, 128, 255)) << "data: 127.5 rounds up";
}

TEST(TextureArena, HiddenColoursOfClearTexelsDoNotBleed) {
    Image image = {rgba(10, 200, 30, 255),
                   rgba(255, 0, 255, 0),
                   rgba(255, 0, 255, 0),
                   rgba(10, 200, 30, 255),
                   0};
    build_mip_chain(image.data(), 2, 2, true);
    EXPECT_EQ(image[4], rgba(10, 200, 30, 128));
}

TEST(TextureArena, AllClearTexelsKeepTheirMeanColour) {
    Image image(5, rgba(40, 90, 200, 0));
    image[4] = 0;
    build_mip_chain(image.data(), 2, 2, true);
    EXPECT_EQ(image[4], rgba(40, 90, 200, 0));
}

TEST(TextureArena, AlphaOfDataIsOneMoreChannel) {
    Image image = {rgba(0, 100, 0, 255), rgba(0, 200, 0, 0), 0};
    build_mip_chain(image.data(), 2, 1, false);
    EXPECT_EQ(image[2], rgba(0, 150, 0, 128));
}

TEST(TextureArena, EveryCodeSurvivesAFlatChain) {
    for (uint32_t code = 0; code < 256; ++code) {
        for (const bool srgb : {false, true}) {
            Image image(mip_chain_texels(5, 4), rgba(code, code, code, 77));
            build_mip_chain(image.data(), 5, 4, srgb);
            for (const uint32_t texel : image)
                ASSERT_EQ(texel, rgba(code, code, code, 77));
        }
    }
}

}  // namespace
}  // namespace obscura
