// tests/image/decode_test.cpp - every kind of PNG, JPEG and WebP, whole, cut off and damaged.
// SPDX-License-Identifier: Apache-2.0
#include "image/decode.h"

#include "base/parallel.h"
#include "image/test_images.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <string>

namespace obscura {
namespace {

using namespace testing_images;

uint32_t rgba(unsigned r, unsigned g, unsigned b, unsigned a = 255) {
    return r | g << 8 | b << 16 | a << 24;
}

ImageRgba8 decoded(const ByteVector& bytes) {
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(bytes, "test", log);
    EXPECT_TRUE(image) << image.error().id << " " << image.error().message;
    EXPECT_TRUE(log.warnings().empty()) << log.warnings().front();
    return image.value_or(ImageRgba8{});
}

std::vector<uint32_t> row_of(const ByteVector& bytes) {
    return decoded(bytes).texels;
}

Error error_of(const ByteVector& bytes) {
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(bytes, "scene.gltf#/images/3", log);
    EXPECT_FALSE(image) << "decoded although it must not";
    return image ? Error{} : image.error();
}

int largest_difference(const ImageRgba8& image,
                       const std::vector<unsigned char>& expected,
                       int channels) {
    int largest = 0;
    for (size_t i = 0; i < image.texels.size(); ++i) {
        for (size_t c = 0; c < static_cast<size_t>(channels); ++c) {
            const int got = static_cast<int>(image.texels[i] >> (8 * c) & 0xFF);
            largest =
                std::max(largest, std::abs(got - expected[i * static_cast<size_t>(channels) + c]));
        }
    }
    return largest;
}

TEST(DecodePng, RgbaKeepsStraightAlphaAndColourUnderAlphaZero) {
    const std::vector<unsigned char> codes = {200, 100, 50, 0, 1, 2, 3, 255, 255, 128, 0, 127};
    const OIIO::ImageSpec spec(3, 1, 4, OIIO::TypeDesc::UINT8);
    const ImageRgba8 image = decoded(encode_with_oiio("png", spec, codes.data()));
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 1);
    EXPECT_EQ(image.format, "png");
    EXPECT_EQ(image.texels,
              (std::vector{rgba(200, 100, 50, 0), rgba(1, 2, 3, 255), rgba(255, 128, 0, 127)}));
}

TEST(DecodePng, RowsComeFromTheTop) {
    const ByteVector png = PngBuilder(1, 2, 8, 0).finish({{10}, {20}});
    EXPECT_EQ(row_of(png), (std::vector{rgba(10, 10, 10), rgba(20, 20, 20)}));
}

TEST(DecodePng, GreyOfEveryDepth) {
    EXPECT_EQ(row_of(PngBuilder(2, 1, 1, 0).finish({{0x40}})),
              (std::vector{rgba(0, 0, 0), rgba(255, 255, 255)}));
    EXPECT_EQ(row_of(PngBuilder(2, 1, 2, 0).finish({{0x60}})),
              (std::vector{rgba(85, 85, 85), rgba(170, 170, 170)}));
    EXPECT_EQ(row_of(PngBuilder(2, 1, 4, 0).finish({{0x1E}})),
              (std::vector{rgba(17, 17, 17), rgba(238, 238, 238)}));
    EXPECT_EQ(row_of(PngBuilder(2, 1, 8, 0).finish({{7, 250}})),
              (std::vector{rgba(7, 7, 7), rgba(250, 250, 250)}));
    EXPECT_EQ(row_of(PngBuilder(2, 1, 16, 0).finish({{0x80, 0x80, 0xFF, 0xFF}})),
              (std::vector{rgba(128, 128, 128), rgba(255, 255, 255)}));
}

TEST(DecodePng, GreyWithAlphaStaysStraight) {
    EXPECT_EQ(row_of(PngBuilder(2, 1, 8, 4).finish({{200, 10, 90, 0}})),
              (std::vector{rgba(200, 200, 200, 10), rgba(90, 90, 90, 0)}));
    EXPECT_EQ(row_of(PngBuilder(1, 1, 16, 4).finish({{0xC8, 0xC8, 0x0A, 0x0A}})),
              (std::vector{rgba(200, 200, 200, 10)}));
}

TEST(DecodePng, PaletteOfEveryDepthWithAndWithoutTransparency) {
    const std::initializer_list<unsigned> colors = {255, 0, 0, 0, 128, 0, 0, 0, 64};
    EXPECT_EQ(row_of(PngBuilder(2, 1, 1, 3).chunk("PLTE", colors).finish({{0x40}})),
              (std::vector{rgba(255, 0, 0), rgba(0, 128, 0)}));
    EXPECT_EQ(row_of(PngBuilder(3, 1, 2, 3).chunk("PLTE", colors).finish({{0x18}})),
              (std::vector{rgba(255, 0, 0), rgba(0, 128, 0), rgba(0, 0, 64)}));
    EXPECT_EQ(row_of(PngBuilder(2, 1, 4, 3).chunk("PLTE", colors).finish({{0x20}})),
              (std::vector{rgba(0, 0, 64), rgba(255, 0, 0)}));
    EXPECT_EQ(row_of(PngBuilder(3, 1, 8, 3)
                         .chunk("PLTE", colors)
                         .chunk("tRNS", {0, 77})
                         .finish({{0, 1, 2}})),
              (std::vector{rgba(255, 0, 0, 0), rgba(0, 128, 0, 77), rgba(0, 0, 64, 255)}));
}

TEST(DecodePng, ColourKeyBecomesAlpha) {
    EXPECT_EQ(
        row_of(
            PngBuilder(2, 1, 8, 2).chunk("tRNS", {0, 9, 0, 8, 0, 7}).finish({{9, 8, 7, 9, 8, 6}})),
        (std::vector{rgba(9, 8, 7, 0), rgba(9, 8, 6, 255)}));
}

TEST(DecodePng, SixteenBitsAreRounded) {
    EXPECT_EQ(row_of(PngBuilder(1, 1, 16, 2).finish({{0x7F, 0xFF, 0x01, 0x80, 0x00, 0x81}})),
              (std::vector{rgba(127, 1, 1)}));
    EXPECT_EQ(row_of(PngBuilder(1, 1, 16, 6).finish({{0xFF, 0xFF, 0, 0, 0x80, 0x80, 0x40, 0x40}})),
              (std::vector{rgba(255, 0, 128, 64)}));
}

/// Channels of the first texel, as stored.
std::array<uint32_t, 4> wide_texel(const ByteVector& png) {
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(png, "wide.png", log, Extent::stored);
    std::array<uint32_t, 4> codes{};
    if (!image || image->bits != 16 || image->low_bytes.size() != image->texels.size())
        return codes;
    for (size_t c = 0; c < 4; ++c) {
        codes[c] =
            (image->texels[0] >> (8 * c) & 255U) << 8 | (image->low_bytes[0] >> (8 * c) & 255U);
    }
    return codes;
}

TEST(DecodePng, SixteenBitsStayWhereTheyAreAskedFor) {
    using Codes = std::array<uint32_t, 4>;
    EXPECT_EQ(wide_texel(PngBuilder(1, 1, 16, 0).finish({{0x12, 0x34}})),
              (Codes{0x1234, 0x1234, 0x1234, 0xFFFF}));
    EXPECT_EQ(wide_texel(PngBuilder(1, 1, 16, 4).finish({{0x12, 0x34, 0x56, 0x78}})),
              (Codes{0x1234, 0x1234, 0x1234, 0x5678}));
    EXPECT_EQ(wide_texel(PngBuilder(1, 1, 16, 2).finish({{0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC}})),
              (Codes{0x1234, 0x5678, 0x9ABC, 0xFFFF}));
    EXPECT_EQ(
        wide_texel(
            PngBuilder(1, 1, 16, 6).finish({{0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0x00, 0x01}})),
        (Codes{0x1234, 0x5678, 0x9ABC, 0x0001}));
    Log log(Verbosity::quiet);
    const ByteVector narrow = PngBuilder(1, 1, 8, 0).finish({{42}});
    const Result<ImageRgba8> image = decode_image(narrow, "narrow.png", log, Extent::stored);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->bits, 8);
    EXPECT_TRUE(image->low_bytes.empty());
}

TEST(DecodePng, GammaAndChromaticitiesChangeNothing) {
    EXPECT_EQ(row_of(PngBuilder(1, 1, 8, 6)
                         .chunk("gAMA", {0, 1, 0x86, 0xA0})
                         .chunk("cHRM", ByteVector(32, std::byte{9}))
                         .finish({{10, 100, 200, 128}})),
              (std::vector{rgba(10, 100, 200, 128)}));
}

TEST(DecodePng, AnAnimationGivesItsStillImageAndAWarning) {
    const ByteVector png =
        PngBuilder(1, 1, 8, 0).chunk("acTL", {0, 0, 0, 2, 0, 0, 0, 0}).finish({{42}});
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(png, "moving.png", log);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->texels[0], rgba(42, 42, 42));
    ASSERT_EQ(log.warnings().size(), 1U);
    EXPECT_NE(log.warnings()[0].find("first frame"), std::string::npos);
}

TEST(DecodePng, OnePixelAndVeryWideImagesWork) {
    EXPECT_EQ(decoded(png_pattern(1, 1, 3)).texels.size(), 1U);
    EXPECT_EQ(decoded(png_pattern(65535, 1, 1)).texels.size(), 65535U);
    EXPECT_EQ(decoded(png_pattern(1, 65535, 1)).texels.size(), 65535U);
}

TEST(DecodeJpeg, ColourGreyAndProgressive) {
    for (const bool progressive : {false, true}) {
        const ImageRgba8 color = decoded(jpeg_pattern(61, 43, 3, progressive));
        EXPECT_EQ(color.format, "jpeg");
        EXPECT_LE(largest_difference(color, pattern(61, 43, 3), 3), 6);
        for (const uint32_t texel : color.texels)
            ASSERT_EQ(texel >> 24, 255U);
        const ImageRgba8 grey = decoded(jpeg_pattern(61, 43, 1, progressive));
        EXPECT_LE(largest_difference(grey, pattern(61, 43, 1), 1), 6);
        for (const uint32_t texel : grey.texels) {
            ASSERT_EQ(texel & 0xFF, texel >> 8 & 0xFF);
            ASSERT_EQ(texel & 0xFF, texel >> 16 & 0xFF);
            ASSERT_EQ(texel >> 24, 255U);
        }
    }
}

/// 8 x 8 pixels of the inverted ink values 255, 128, 0, 200, as Adobe's programs store them.
ByteVector cmyk_jpeg() {
    ByteVector jpeg;
    append(jpeg,
           {0xFF, 0xD8, 0xFF, 0xEE, 0x00, 0x0E, 'A', 'd', 'o', 'b', 'e', 0, 0x64, 0, 0, 0, 0, 0});
    append(jpeg, {0xFF, 0xDB, 0x00, 0x43, 0x00});
    for (int i = 0; i < 64; ++i)
        append(jpeg, {1});
    append(jpeg, {0xFF, 0xC0, 0x00, 0x14, 0x08, 0x00, 0x08, 0x00, 0x08, 0x04});
    for (const unsigned id : {0x43U, 0x4DU, 0x59U, 0x4BU})  // C, M, Y, K
        append(jpeg, {id, 0x11, 0x00});
    append(jpeg, {0xFF, 0xC4, 0x00, 0x16, 0x00, 1, 1, 1});
    for (int i = 0; i < 13; ++i)
        append(jpeg, {0});
    append(jpeg, {0x0A, 0x00, 0x0B, 0xFF, 0xC4, 0x00, 0x14, 0x10, 1});
    for (int i = 0; i < 16; ++i)
        append(jpeg, {0});
    append(jpeg, {0xFF, 0xDA, 0x00, 0x0E, 0x04, 'C', 0, 'M', 0, 'Y', 0, 'K', 0, 0x00, 0x3F, 0x00});
    append(jpeg, {0x7F, 0x09, 0x9F, 0xF9, 0x20, 0x3F, 0xFF, 0xD9});
    return jpeg;
}

TEST(DecodeJpeg, CmykBecomesRgb) {
    for (const uint32_t texel : decoded(cmyk_jpeg()).texels)
        ASSERT_EQ(texel, rgba(200, 100, 0));
}

TEST(DecodeJpeg, StrayBytesAreSkipped) {
    const ByteVector clean = jpeg_pattern(16, 16, 3);
    const ImageRgba8 expected = decoded(clean);
    ByteVector before_scan = clean;
    for (size_t i = 2; i + 1 < clean.size(); ++i) {
        if (clean[i] == std::byte{0xFF} && clean[i + 1] == std::byte{0xDA}) {
            const auto at = before_scan.begin() + static_cast<std::ptrdiff_t>(i);
            before_scan.insert(at, 3, std::byte{0x11});
            break;
        }
    }
    EXPECT_EQ(decoded(before_scan).texels, expected.texels);
    ByteVector after_end = clean;
    append_text(after_end, "appended by a camera");
    EXPECT_EQ(decoded(after_end).texels, expected.texels);
}

TEST(DecodeJpeg, StrayBytesBetweenScansAreAWarning) {
    ByteVector jpeg = jpeg_pattern(16, 16, 3, true);
    const ImageRgba8 expected = decoded(jpeg);
    int scans = 0;
    for (size_t i = 2; i + 1 < jpeg.size(); ++i) {
        if (jpeg[i] == std::byte{0xFF} && jpeg[i + 1] == std::byte{0xDA} && ++scans == 2) {
            jpeg.insert(jpeg.begin() + static_cast<std::ptrdiff_t>(i), 3, std::byte{0x11});
            break;
        }
    }
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(jpeg, "stray.jpg", log);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->texels, expected.texels);
    ASSERT_EQ(log.warnings().size(), 1U);
    EXPECT_EQ(log.warnings()[0].rfind("stray.jpg: ", 0), 0U);
}

TEST(DecodeWebp, LosslessIsExactAndStraight) {
    const ImageRgba8 image = decoded(webp_pattern(31, 17, true));
    EXPECT_EQ(image.format, "webp");
    const std::vector<unsigned char> expected = pattern(31, 17, 4);
    for (size_t i = 0; i < image.texels.size(); ++i) {
        ASSERT_EQ(image.texels[i] >> 24, expected[4 * i + 3]);
        // The encoder is free to change the colour of invisible pixels.
        if (expected[4 * i + 3] == 0) continue;
        ASSERT_EQ(image.texels[i] & 0xFF, expected[4 * i]);
        ASSERT_EQ(image.texels[i] >> 8 & 0xFF, expected[4 * i + 1]);
        ASSERT_EQ(image.texels[i] >> 16 & 0xFF, expected[4 * i + 2]);
    }
}

TEST(DecodeWebp, LossyKeepsAlpha) {
    const ImageRgba8 image = decoded(webp_pattern(64, 64, false));
    const std::vector<unsigned char> expected = pattern(64, 64, 4);
    for (size_t i = 0; i < image.texels.size(); ++i) {
        ASSERT_EQ(image.texels[i] >> 24, expected[4 * i + 3]);
    }
}

void append_riff_chunk(ByteVector& out, std::string_view id, const ByteVector& data) {
    append_text(out, id);
    const auto size = static_cast<unsigned>(data.size());
    append(out, {size, size >> 8, size >> 16, size >> 24});
    out.insert(out.end(), data.begin(), data.end());
    if (size % 2 != 0) append(out, {0});
}

TEST(DecodeWebp, AnAnimationGivesItsFirstFrameAndAWarning) {
    const ByteVector still = webp_pattern(16, 8, true);
    ByteVector frame;
    append(frame, {0, 0, 0, 0, 0, 0, 15, 0, 0, 7, 0, 0, 100, 0, 0, 0});
    frame.insert(frame.end(), still.begin() + 12, still.end());  // after RIFF, size, WEBP
    ByteVector body;
    append_text(body, "WEBP");
    ByteVector canvas;
    append(canvas, {0x12, 0, 0, 0, 15, 0, 0, 7, 0, 0});  // animation and alpha
    append_riff_chunk(body, "VP8X", canvas);
    append_riff_chunk(body, "ANIM", ByteVector(6));
    append_riff_chunk(body, "ANMF", frame);
    append_riff_chunk(body, "ANMF", frame);
    ByteVector webp;
    append_riff_chunk(webp, "RIFF", body);

    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(webp, "moving.webp", log);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->width, 16);
    EXPECT_EQ(image->height, 8);
    ASSERT_EQ(log.warnings().size(), 1U);
    const std::vector<unsigned char> expected = pattern(16, 8, 4);
    for (size_t i = 0; i < image->texels.size(); ++i) {
        ASSERT_EQ(image->texels[i] >> 24, expected[4 * i + 3]) << i;
    }
    webp.resize(webp.size() / 2);
    EXPECT_EQ(error_of(webp).code, ExitCode::bad_resource);
}

std::vector<std::pair<std::string, ByteVector>> one_of_each() {
    return {{"png", png_pattern(97, 61, 4)},
            {"png grey", png_pattern(97, 61, 1)},
            {"jpeg", jpeg_pattern(97, 61, 3)},
            {"progressive jpeg", jpeg_pattern(97, 61, 3, true)},
            {"webp", webp_pattern(97, 61, false)},
            {"lossless webp", webp_pattern(97, 61, true)}};
}

TEST(DecodeImage, CutOffImagesAre67WhereverTheyEnd) {
    for (const auto& [name, whole] : one_of_each()) {
        for (size_t tenth = 0; tenth < 10; ++tenth) {
            ByteVector cut = whole;
            cut.resize(whole.size() * tenth / 10);
            const Error error = error_of(cut);
            EXPECT_EQ(error.code, ExitCode::bad_resource) << name << " at " << tenth << "/10";
            EXPECT_EQ(error.id, tenth == 0 ? "E-IMG-FORMAT" : "E-IMG-CORRUPT") << name;
            EXPECT_EQ(error.where, "scene.gltf#/images/3");
            EXPECT_FALSE(error.message.empty());
        }
    }
}

TEST(DecodeImage, EveryShortHeaderIsAnErrorAndNeverACrash) {
    for (const auto& [name, whole] : one_of_each()) {
        for (size_t size = 0; size < 120; ++size) {
            const ByteVector cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            EXPECT_EQ(error_of(cut).code, ExitCode::bad_resource) << name << " " << size;
        }
    }
}

TEST(DecodeImage, DamagedImagesDecodeOrFailCleanly) {
    std::mt19937 random(7);
    for (const auto& [name, whole] : one_of_each()) {
        for (int round = 0; round < 200; ++round) {
            ByteVector damaged = whole;
            for (int i = 0; i < 4; ++i) {
                damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << random() % 8);
            }
            Log log(Verbosity::quiet);
            const Result<ImageRgba8> image = decode_image(damaged, name, log);
            if (image) {
                EXPECT_EQ(image->texels.size(),
                          static_cast<size_t>(image->width) * static_cast<size_t>(image->height));
            } else {
                EXPECT_EQ(image.error().id.rfind("E-IMG-", 0), 0U) << image.error().id;
            }
        }
    }
}

TEST(DecodeImage, ADamagedPngChecksumIs67) {
    ByteVector png = png_pattern(64, 64, 3);
    for (size_t i = 0; i + 4 < png.size(); ++i) {
        if (std::memcmp(png.data() + i, "IDAT", 4) == 0) png[i + 30] ^= std::byte{0x55};
    }
    EXPECT_EQ(error_of(png).id, "E-IMG-CORRUPT");
}

TEST(DecodeImage, ManyAtOnceGiveTheSameTexels) {
    const ThreadLimit limit(4);
    const auto images = one_of_each();
    std::vector<std::vector<uint32_t>> expected;
    for (const auto& [name, bytes] : images)
        expected.push_back(row_of(bytes));
    std::atomic<int> wrong{0};
    parallel_for(200, [&](size_t i) {
        const size_t which = i % images.size();
        Log log(Verbosity::quiet);
        const Result<ImageRgba8> image = decode_image(images[which].second, "parallel", log);
        if (!image || image->texels != expected[which]) ++wrong;
    });
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace obscura
