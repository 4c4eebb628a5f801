// tests/image/encode_display_test.cpp - every format for displays: pixels, alpha, tags, limits.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"
#include "image/icc_profile.h"
#include "image/output_tags.h"
#include "image/test_images.h"

#include <cmath>
#include <cstdlib>
#include <gmock/gmock.h>
#include <random>
#include <webp/decode.h>

namespace obscura {
namespace {

using namespace testing_images;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr OutputFormat all_for_displays[] = {OutputFormat::png,
                                             OutputFormat::jpeg,
                                             OutputFormat::tiff,
                                             OutputFormat::webp,
                                             OutputFormat::avif};

/// Straight colour and alpha of a pixel of `ramp`, from 0 to 1.
std::array<double, 4> ramp_at(int x, int y) {
    return {x / 63.0, y / 31.0, (x + y) / 94.0, 0.25 + 0.75 * x / 63.0};
}

/// 64 x 32 pixels, premultiplied as images are.
OutputImage ramp(bool with_alpha) {
    OutputImage image{64, 32, {"R", "G", "B"}, {}};
    if (with_alpha) image.channels.emplace_back("A");
    for (int i = 0; i < 64 * 32; ++i) {
        const std::array<double, 4> pixel = ramp_at(i % 64, i / 64);
        const double scale = with_alpha ? pixel[3] : 1;
        for (size_t c = 0; c < 3; ++c)
            image.pixels.push_back(static_cast<float>(pixel[c] * scale));
        if (with_alpha) image.pixels.push_back(static_cast<float>(pixel[3]));
    }
    return image;
}

/// What another reader sees: straight alpha, from 0 to 1.
struct ReadBack {
    OIIO::ImageSpec spec;
    std::vector<float> values;
};

class EncodeDisplay : public FolderTest {
protected:
    static DisplayTransform display_of(const char* view) {
        Log log(Verbosity::quiet);
        auto display = DisplayTransform::create(DisplayOptions{{}, {}, view, 0}, log);
        EXPECT_TRUE(display);
        return std::move(*display);
    }

    static Result<ByteVector> encode(OutputFormat format,
                                     const OutputImage& image,
                                     const DisplayEncoding& encoding,
                                     bool is_color = true) {
        ImageMetadata metadata;
        metadata.software = "Obscura 0.1.0";
        metadata.is_color = is_color;
        Result<EncodedFile> file = encode_image({format, "it"}, image, metadata, {}, encoding);
        if (!file) return fail(file.error());
        return std::move(file->bytes);
    }
    static ByteVector encoded(OutputFormat format,
                              const OutputImage& image,
                              const DisplayEncoding& encoding,
                              bool is_color = true) {
        const Result<ByteVector> bytes = encode(format, image, encoding, is_color);
        EXPECT_TRUE(bytes) << bytes.error().message;
        return bytes ? *bytes : ByteVector();
    }

    ReadBack read(OutputFormat format, const ByteVector& bytes) {
        ReadBack out;
        if (format == OutputFormat::webp) return read_webp(bytes);
        const std::filesystem::path file =
            folder_ / (std::string("x") + entry_of(format).endings[0]);
        write_bytes(file, bytes);
        OIIO::ImageSpec wishes;
        wishes.attribute("oiio:UnassociatedAlpha", 1);
        const auto input = OIIO::ImageInput::open(file.string(), &wishes);
        EXPECT_TRUE(input) << OIIO::geterror();
        if (!input) return out;
        out.spec = input->spec();
        out.values.resize(out.spec.image_pixels() * static_cast<size_t>(out.spec.nchannels));
        EXPECT_TRUE(input->read_image(
            0, 0, 0, out.spec.nchannels, OIIO::TypeDesc::FLOAT, out.values.data()));
        return out;
    }

    /// OpenImageIO multiplies a WebP by its alpha: libwebp itself does not.
    static ReadBack read_webp(const ByteVector& bytes) {
        ReadBack out;
        WebPBitstreamFeatures features;
        const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
        EXPECT_EQ(WebPGetFeatures(data, bytes.size(), &features), VP8_STATUS_OK);
        const int channels = features.has_alpha != 0 ? 4 : 3;
        out.spec =
            OIIO::ImageSpec(features.width, features.height, channels, OIIO::TypeDesc::UINT8);
        uint8_t* codes = channels == 4
                             ? WebPDecodeRGBA(data, bytes.size(), &out.spec.width, &out.spec.height)
                             : WebPDecodeRGB(data, bytes.size(), &out.spec.width, &out.spec.height);
        const size_t count = out.spec.image_pixels() * static_cast<size_t>(channels);
        for (size_t i = 0; i < count; ++i)
            out.values.push_back(static_cast<float>(codes[i]) / 255);
        WebPFree(codes);
        return out;
    }

    /// Compares with the ramp; pixels that are nearly clear are left out where `loss` is allowed.
    static void expect_ramp(const ReadBack& found, double tolerance, bool loss = false) {
        ASSERT_EQ(found.spec.width, 64);
        ASSERT_EQ(found.spec.height, 32);
        const auto channels = static_cast<size_t>(found.spec.nchannels);
        double sum = 0;
        for (int i = 0; i < 64 * 32; ++i) {
            const std::array<double, 4> expected = ramp_at(i % 64, i / 64);
            for (size_t c = 0; c < channels; ++c) {
                const auto at = static_cast<size_t>(i) * channels + c;
                const double error = std::abs(static_cast<double>(found.values[at]) - expected[c]);
                ASSERT_LE(error, loss ? 1 : tolerance) << i << ' ' << c;
                sum += error;
            }
        }
        EXPECT_LE(sum / (64.0 * 32 * static_cast<double>(channels)), tolerance);
    }

    const DisplayTransform raw_ = display_of("Raw");
    const DisplayTransform srgb_ = display_of("Un-tone-mapped");
};

TEST_F(EncodeDisplay, FormatsWithoutLossKeepCodesAndStraightAlpha) {
    DisplayEncoding encoding;
    encoding.transform = &raw_;
    encoding.quality = 100;  // what makes a WebP lose nothing
    encoding.dither = false;
    for (const OutputFormat format : {OutputFormat::png, OutputFormat::tiff, OutputFormat::webp}) {
        for (const bool with_alpha : {false, true}) {
            SCOPED_TRACE(entry_of(format).name);
            const ReadBack found = read(format, encoded(format, ramp(with_alpha), encoding));
            EXPECT_EQ(found.spec.nchannels, with_alpha ? 4 : 3);
            EXPECT_EQ(found.spec.format, OIIO::TypeDesc::UINT8);
            expect_ramp(found, 0.501 / 255);
        }
    }
}

TEST_F(EncodeDisplay, SixteenBitsKeepSixteen) {
    DisplayEncoding encoding;
    encoding.transform = &raw_;
    encoding.bits = 16;
    for (const OutputFormat format : {OutputFormat::png, OutputFormat::tiff}) {
        for (const bool with_alpha : {false, true}) {
            SCOPED_TRACE(entry_of(format).name);
            const ReadBack found = read(format, encoded(format, ramp(with_alpha), encoding));
            EXPECT_EQ(found.spec.format, OIIO::TypeDesc::UINT16);
            expect_ramp(found, 1.01 / 65535);
        }
    }
}

TEST_F(EncodeDisplay, FormatsWithLossLoseLittleAndKeepAlpha) {
    DisplayEncoding encoding;
    encoding.transform = &raw_;
    for (const OutputFormat format : {OutputFormat::jpeg, OutputFormat::webp, OutputFormat::avif}) {
        if (format == OutputFormat::avif && !can_write_avif()) continue;
        SCOPED_TRACE(entry_of(format).name);
        expect_ramp(read(format, encoded(format, ramp(false), encoding)), 0.02, true);
        if (format == OutputFormat::jpeg) continue;
        const ReadBack clear = read(format, encoded(format, ramp(true), encoding));
        ASSERT_EQ(clear.spec.nchannels, 4);
        expect_ramp(clear, 0.02, true);
    }
}

TEST_F(EncodeDisplay, BetterQualityTakesMoreBytes) {
    OutputImage image = ramp(false);
    std::minstd_rand random(1);  // a pattern would take next to nothing without loss
    for (float& value : image.pixels)
        value = static_cast<float>(random() % 1000) / 1000;
    for (const OutputFormat format : {OutputFormat::jpeg, OutputFormat::webp, OutputFormat::avif}) {
        if (format == OutputFormat::avif && !can_write_avif()) continue;
        SCOPED_TRACE(entry_of(format).name);
        size_t smaller = 0;
        for (const int quality : {1, 40, 80, 100}) {
            DisplayEncoding encoding;
            encoding.quality = quality;
            const size_t size = encoded(format, image, encoding).size();
            EXPECT_GT(size, smaller) << quality;
            smaller = size;
        }
    }
    DisplayEncoding encoding;
    encoding.quality = 95;
    EXPECT_EQ(encoded(OutputFormat::jpeg, image, encoding), encoded(OutputFormat::jpeg, image, {}));
    encoding.quality = 90;
    EXPECT_EQ(encoded(OutputFormat::webp, image, encoding), encoded(OutputFormat::webp, image, {}));
}

TEST_F(EncodeDisplay, APngSaysSrgbInAChunkAndHasNoOffset) {
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    OutputImage image = ramp(true);
    for (const bool crop : {false, true}) {
        if (crop) image.part_of = ImagePart{100, 90, 20, 30};
        const ByteVector png = encoded(OutputFormat::png, image, encoding);
        const std::vector<Chunk> chunks = png_chunks(png);
        EXPECT_EQ(data_of(chunks, "sRGB"), ByteVector{std::byte{0}});
        const std::vector<std::string> types = types_of(chunks);
        EXPECT_EQ(types[0], "IHDR");
        EXPECT_EQ(types[1], "sRGB") << "in front of the pixels";
        EXPECT_EQ(types.back(), "IEND");
        for (const char* absent : {"oFFs", "iCCP", "cICP", "broken"})
            EXPECT_THAT(types, Not(Contains(absent)));
        EXPECT_EQ(data_of(chunks, "IHDR")[9], std::byte{6}) << "straight alpha is all that PNG has";
    }
}

/// The codes of other displays, of data, and of no display at all are not those of sRGB.
TEST_F(EncodeDisplay, WhatIsNotSrgbIsNotCalledSrgb) {
    const auto expect_untagged = [&](const DisplayEncoding& encoding, bool is_color) {
        const auto bytes = [&](OutputFormat format) {
            return encoded(format, ramp(false), encoding, is_color);
        };
        const auto chunks = types_of(png_chunks(bytes(OutputFormat::png)));
        for (const char* absent : {"sRGB", "cICP", "gAMA", "cHRM", "iCCP"})
            EXPECT_THAT(chunks, Not(Contains(absent)));
        EXPECT_THAT(jpeg_profile(bytes(OutputFormat::jpeg)), IsEmpty());
        EXPECT_THAT(tiff_tag(bytes(OutputFormat::tiff), 34675), IsEmpty());
        EXPECT_THAT(data_of(webp_chunks(bytes(OutputFormat::webp)), "ICCP"), IsEmpty());
    };
    DisplayEncoding encoding;
    expect_untagged(encoding, true);
    encoding.transform = &raw_;
    expect_untagged(encoding, true);
    encoding.transform = &srgb_;
    expect_untagged(encoding, false);
}

TEST_F(EncodeDisplay, JpegTiffAndWebpHaveTheProfileOfSrgb) {
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    const ByteVector profile = srgb_icc_profile();
    EXPECT_EQ(jpeg_profile(encoded(OutputFormat::jpeg, ramp(false), encoding)), profile);
    EXPECT_EQ(bytes_of(tiff_tag(encoded(OutputFormat::tiff, ramp(true), encoding), 34675)),
              profile);
    for (const int quality : {90, 100}) {
        for (const bool with_alpha : {false, true}) {
            encoding.quality = quality;
            const auto chunks =
                webp_chunks(encoded(OutputFormat::webp, ramp(with_alpha), encoding));
            EXPECT_EQ(data_of(chunks, "ICCP"), profile);
            const ByteVector features = data_of(chunks, "VP8X");
            ASSERT_FALSE(features.empty());
            EXPECT_EQ(features[0] & std::byte{0x20}, std::byte{0x20}) << "it announces the profile";
            EXPECT_EQ((features[0] & std::byte{0x10}) != std::byte{0}, with_alpha);
            EXPECT_EQ(data_of(chunks, "VP8L").empty(), quality < 100);
        }
    }
}

TEST_F(EncodeDisplay, AnotherDisplaysCodePointsStandInAPng) {
    const std::vector<uint8_t> codes(4 * 4 * 3, 99);
    PngImage image{.width = 4, .height = 4, .channels = 3, .codes = codes.data()};
    const auto same = png_chunks(encode_png(image, "").value());
    image.code_points = ColorCodePoints{12, 13};
    const auto wide = png_chunks(encode_png(image, "").value());
    EXPECT_EQ(data_of(wide, "cICP"),
              (ByteVector{std::byte{12}, std::byte{13}, std::byte{0}, std::byte{1}}));
    EXPECT_THAT(types_of(wide), Not(Contains("sRGB")));
    EXPECT_EQ(data_of(wide, "IDAT"), data_of(same, "IDAT"));
}

TEST_F(EncodeDisplay, TiffAlphaIsCalledStraight) {
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    for (const int bits : {8, 16}) {
        encoding.bits = bits;
        const ByteVector clear = encoded(OutputFormat::tiff, ramp(true), encoding);
        EXPECT_THAT(tiff_tag(clear, 338), ElementsAre(2)) << "ExtraSamples: unassociated alpha";
        EXPECT_THAT(tiff_tag(clear, 277), ElementsAre(4)) << "SamplesPerPixel";
        EXPECT_THAT(tiff_tag(clear, 258), Contains(bits)) << "BitsPerSample";
        EXPECT_THAT(tiff_tag(clear, 262), ElementsAre(2)) << "PhotometricInterpretation: RGB";
        const ByteVector opaque = encoded(OutputFormat::tiff, ramp(false), encoding);
        EXPECT_THAT(tiff_tag(opaque, 338), IsEmpty());
    }
}

TEST_F(EncodeDisplay, AWhitePageIsWhiteInEveryFormat) {
    OutputImage image = ramp(true);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    encoding.page = {1, 1, 1};
    for (const OutputFormat format : all_for_displays) {
        if (format == OutputFormat::avif && !can_write_avif()) continue;
        for (const int quality : {30, 90, 100}) {
            SCOPED_TRACE(entry_of(format).name);
            encoding.quality = quality;
            const ReadBack found = read(format, encoded(format, image, encoding));
            EXPECT_EQ(found.spec.nchannels, 3) << "alpha leaves the file";
            // libwebp itself may lose a code of what it is given at low qualities.
            const bool lossy = format == OutputFormat::webp && quality == 30;
            for (const float value : found.values)
                ASSERT_GE(value, lossy ? 254.0f / 255 : 1.0f) << quality;
        }
    }
}

/// A crop's pixels have the codes that the whole image has there, dither included; the page lies
/// around it.
TEST_F(EncodeDisplay, ACropHasTheCodesOfTheWhole) {
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    const OutputImage whole = ramp(true);
    OutputImage part{20, 10, whole.channels, {}, ImagePart{64, 32, 7, 5}};
    for (size_t y = 5; y < 15; ++y) {
        const auto row = whole.pixels.begin() + static_cast<long>((y * 64 + 7) * 4);
        part.pixels.insert(part.pixels.end(), row, row + 80);
    }
    const auto all = read(OutputFormat::png, encoded(OutputFormat::png, whole, encoding));
    const auto cut = read(OutputFormat::png, encoded(OutputFormat::png, part, encoding));
    ASSERT_EQ(cut.values.size(), all.values.size());
    for (size_t i = 0; i < all.values.size(); ++i) {
        const size_t x = i / 4 % 64;
        const size_t y = i / 256;
        const bool inside = x >= 7 && x < 27 && y >= 5 && y < 15;
        ASSERT_EQ(cut.values[i], inside ? all.values[i] : 0) << x << ',' << y;
    }
    encoding.page = {1, 1, 1};
    const auto paged = read(OutputFormat::png, encoded(OutputFormat::png, part, encoding));
    EXPECT_EQ(paged.values[0], 1);
}

TEST_F(EncodeDisplay, GreyDataFitEveryFormat) {
    OutputImage image{32, 32, {"Z"}, {}};
    image.pixels.assign(size_t{32} * 32, 0.5f);
    DisplayEncoding encoding;
    encoding.transform = &srgb_;
    for (const OutputFormat format : all_for_displays) {
        if (format == OutputFormat::avif && !can_write_avif()) continue;
        SCOPED_TRACE(entry_of(format).name);
        for (const float value : read(format, encoded(format, image, encoding, false)).values)
            ASSERT_NEAR(value, 0.5f, 0.01f);
    }
}

TEST_F(EncodeDisplay, WhatAFormatCannotHoldIsRefusedBeforeTheWork) {
    DisplayEncoding fine;
    fine.bits = 16;
    for (const OutputFormat format : {OutputFormat::jpeg, OutputFormat::webp, OutputFormat::avif}) {
        const Result<void> refused = check_encoding({format, "a"}, fine, 8, 8);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ExitCode::usage);
        EXPECT_EQ(refused.error().id, "E-USAGE-CONFLICT");
        EXPECT_EQ(encode(format, ramp(false), fine).error().id, "E-USAGE-CONFLICT");
    }
    for (const OutputFormat format : {OutputFormat::png, OutputFormat::tiff, OutputFormat::exr})
        EXPECT_TRUE(check_encoding({format, "a"}, fine, 8, 8));
    const Result<void> wide = check_encoding({OutputFormat::webp, "a.webp"}, {}, 16384, 8);
    ASSERT_FALSE(wide);
    EXPECT_EQ(wide.error().id, "E-OUT-FORMAT");
    EXPECT_TRUE(check_encoding({OutputFormat::webp, "a.webp"}, {}, 16383, 8));
    EXPECT_FALSE(check_encoding({OutputFormat::jpeg, "a.jpg"}, {}, 8, 65501));
    EXPECT_EQ(check_encoding({OutputFormat::avif, "a.avif"}, {}, 8, 8).has_value(),
              can_write_avif());
    const OutputImage long_row{16384, 1, {"Z"}, UnsetArray<float>(16384, 0.0f)};
    EXPECT_EQ(encode(OutputFormat::webp, long_row, {}).error().id, "E-OUT-FORMAT");
}

TEST_F(EncodeDisplay, AvifSaysWhenTheTemporaryFolderIsMissing) {
    if (!can_write_avif()) GTEST_SKIP() << "this OpenImageIO writes no AVIF";
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    ::setenv("TMPDIR", (folder_ / "absent").c_str(), 1);
    const Result<ByteVector> bytes = encode(OutputFormat::avif, ramp(false), {});
    before ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().id, "E-OUT-WRITE");
}

}  // namespace
}  // namespace obscura
