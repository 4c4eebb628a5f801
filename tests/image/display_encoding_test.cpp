// tests/image/display_encoding_test.cpp - dither, pages and rounding, against formulas in double.
// SPDX-License-Identifier: Apache-2.0
#include "image/display_encoding.h"

#include "image/write.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

double srgb_code(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

OutputImage constant(int width, int height, std::vector<float> pixel) {
    OutputImage image{width, height, {"R", "G", "B", "A"}, {}};
    image.channels.resize(pixel.size());
    for (int i = 0; i < width * height; ++i)
        image.pixels.insert(image.pixels.end(), pixel.begin(), pixel.end());
    return image;
}

class Encoding : public testing::Test {
protected:
    static DisplayTransform display_of(const char* view) {
        Log log(Verbosity::quiet);
        Result<DisplayTransform> display =
            DisplayTransform::create(DisplayOptions{{}, {}, view, 0}, log);
        EXPECT_TRUE(display);
        return std::move(*display);
    }

    /// The red codes of a constant grey value through the view Raw, which leaves it as it is.
    std::vector<uint8_t> dithered(int side, float value) const {
        DisplayEncoding encoding;
        encoding.transform = &raw_;
        const auto codes =
            display_codes<uint8_t>(constant(side, side, {value, value, value}), false, encoding);
        std::vector<uint8_t> red;
        for (size_t i = 0; i < codes.size(); i += 3) {
            red.push_back(codes[i]);
            EXPECT_TRUE(codes[i] == codes[i + 1] && codes[i] == codes[i + 2]) << "grey stays grey";
        }
        return red;
    }

    const DisplayTransform raw_ = display_of("Raw");
    const DisplayTransform srgb_ = display_of("Un-tone-mapped");
};

TEST_F(Encoding, DitherKeepsTheMeanOfEveryArea) {
    constexpr int side = 64;
    for (double code = 0.03; code < 255; code += 6.37) {
        const std::vector<uint8_t> found = dithered(side, static_cast<float>(code / 255));
        for (const int area : {10, 13, 32, 64}) {
            for (int y = 0; y + area <= side; y += 5) {
                for (int x = 0; x + area <= side; x += 7) {
                    double sum = 0;
                    for (int i = 0; i < area * area; ++i) {
                        const int at = (y + i / area) * side + x + i % area;
                        sum += found[static_cast<size_t>(at)];
                    }
                    ASSERT_NEAR(sum / (area * area), code, 0.05) << area << " at " << x << ',' << y;
                }
            }
        }
        const auto [low, high] = std::minmax_element(found.begin(), found.end());
        EXPECT_GE(*low, std::floor(code)) << "the two nearest codes only";
        EXPECT_LE(*high, std::ceil(code));
        EXPECT_LT(*low, *high) << "it is dithered";
    }
}

TEST_F(Encoding, WholeCodesStayWhatTheyAre) {
    for (int code = 0; code < 256; ++code) {
        for (const uint8_t found : dithered(16, static_cast<float>(code) / 255))
            ASSERT_EQ(found, code);
    }
    for (const uint8_t found : dithered(16, 3.5f))
        ASSERT_EQ(found, 255) << "beyond white";
    for (const uint8_t found : dithered(16, -1))
        ASSERT_EQ(found, 0);
}

/// A mask of rows would have long runs; neighbours of this one differ.
TEST_F(Encoding, DitherHasNoStripes) {
    constexpr int side = 32;
    const std::vector<uint8_t> found = dithered(side, 100.5f / 255);
    for (int y = 1; y < side; ++y) {
        int same_above = 0;
        int same_beside = 0;
        for (int x = 1; x < side; ++x) {
            const auto at = static_cast<size_t>(y * side + x);
            same_above += found[at] == found[at - side] ? 1 : 0;
            same_beside += found[at] == found[at - 1] ? 1 : 0;
        }
        EXPECT_LT(same_above, 24) << y;
        EXPECT_LT(same_beside, 24) << y;
    }
}

TEST_F(Encoding, DataAlphaSixteenBitsAndNoDitherAreRounded) {
    constexpr float value = 100.4f / 255;
    const OutputImage image = constant(16, 16, {value, value, value, value});
    DisplayEncoding encoding;
    for (const uint8_t code : display_codes<uint8_t>(constant(16, 16, {value}), false, encoding))
        ASSERT_EQ(code, 100) << "data";
    encoding.transform = &raw_;
    const auto with_alpha = display_codes<uint8_t>(image, true, encoding);
    for (size_t i = 3; i < with_alpha.size(); i += 4)
        ASSERT_EQ(with_alpha[i], 100) << "alpha";
    for (const uint16_t code :
         display_codes<uint16_t>(constant(16, 16, {value, value, value}), false, encoding)) {
        ASSERT_EQ(code, std::lround(100.4 * 257));
    }
    encoding.dither = false;
    for (const uint8_t code :
         display_codes<uint8_t>(constant(16, 16, {value, value, value}), false, encoding)) {
        ASSERT_EQ(code, 100);
    }
}

TEST_F(Encoding, APageIsExactWhereNothingIs) {
    for (const auto& page : {std::array<float, 3>{1, 1, 1},
                             std::array<float, 3>{0, 0, 0},
                             std::array<float, 3>{0x12 / 255.0f, 0x80 / 255.0f, 0xFE / 255.0f}}) {
        DisplayEncoding encoding;
        encoding.transform = &srgb_;
        encoding.page = page;
        const auto codes = display_codes<uint8_t>(constant(20, 20, {0, 0, 0, 0}), true, encoding);
        ASSERT_EQ(codes.size(), 1200U) << "alpha leaves the file";
        for (size_t i = 0; i < codes.size(); ++i)
            ASSERT_EQ(codes[i], std::lround(page[i % 3] * 255));
    }
}

/// An edge: the same surface with coverage from 0 to 1. Truth: its own code and the page's, mixed
/// by coverage, so that no channel leaves the span between both.
TEST_F(Encoding, EdgesMixTheSurfaceWithThePageAndNothingElse) {
    const double surface[3] = {0.9, 0.05, 0.4};
    const std::array<float, 3> page = {1, 0.5f, 0};
    OutputImage image{101, 1, {"R", "G", "B", "A"}, {}};
    for (int i = 0; i <= 100; ++i) {
        for (const double channel : surface)
            image.pixels.push_back(static_cast<float>(channel * i / 100));
        image.pixels.push_back(static_cast<float>(i) / 100);
    }
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    encoding.page = page;
    encoding.dither = false;
    const auto codes = display_codes<uint8_t>(image, true, encoding);
    const auto fine = display_codes<uint16_t>(image, false, encoding);
    for (size_t i = 0; i <= 100; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            const double coverage = static_cast<double>(i) / 100;
            const double expected =
                coverage * srgb_code(surface[c]) + (1 - coverage) * static_cast<double>(page[c]);
            EXPECT_NEAR(codes[3 * i + c], 255 * expected, 0.51) << i << ' ' << c;
            EXPECT_NEAR(fine[3 * i + c], 65535 * expected, 2) << i << ' ' << c;
        }
    }
}

TEST_F(Encoding, AnOpaqueImageHidesThePage) {
    DisplayEncoding encoding;
    encoding.transform = &raw_;
    encoding.page = {1, 1, 1};
    for (const std::vector<float>& pixel :
         {std::vector<float>{0.2f, 0.2f, 0.2f, 1}, std::vector<float>{0.2f, 0.2f, 0.2f}}) {
        for (const uint8_t code : display_codes<uint8_t>(constant(4, 4, pixel), true, encoding))
            EXPECT_EQ(code, 51);
    }
}

}  // namespace
}  // namespace obscura
