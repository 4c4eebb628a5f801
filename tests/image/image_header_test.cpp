// tests/image/image_header_test.cpp - size and format are read, and checked, before decoding.
// SPDX-License-Identifier: Apache-2.0
#include "image/image_header.h"

#include "image/decode.h"
#include "image/test_images.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using namespace testing_images;

/// The error of the header, which decoding must report too.
Error error_of(const ByteVector& bytes) {
    const Result<ImageHeader> header = read_image_header(bytes, "scene.gltf#/images/3");
    EXPECT_FALSE(header) << "accepted although it must not be";
    if (header) return {};
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = decode_image(bytes, "scene.gltf#/images/3", log);
    EXPECT_TRUE(!image && image.error().id == header.error().id);
    EXPECT_EQ(header.error().where, "scene.gltf#/images/3");
    return header.error();
}

TEST(ImageHeader, SizeIsReadFromEveryFormat) {
    const std::pair<ImageFormat, ByteVector> images[] = {
        {ImageFormat::png, png_pattern(97, 61, 4)},
        {ImageFormat::jpeg, jpeg_pattern(97, 61, 3)},
        {ImageFormat::jpeg, jpeg_pattern(97, 61, 1, true)},
        {ImageFormat::webp, webp_pattern(97, 61, false)},
        {ImageFormat::webp, webp_pattern(97, 61, true)}};
    for (const auto& [format, bytes] : images) {
        const Result<ImageHeader> header = read_image_header(bytes, "test");
        ASSERT_TRUE(header) << header.error().message;
        EXPECT_EQ(header->format, format);
        EXPECT_EQ(header->width, 97);
        EXPECT_EQ(header->height, 61);
        EXPECT_FALSE(header->animated);
        const Result<ImageRgba8> probe = probe_image(bytes, "test");
        ASSERT_TRUE(probe);
        EXPECT_EQ(probe->width, 97);
        EXPECT_EQ(probe->height, 61);
        EXPECT_EQ(probe->format, format_name(format));
        EXPECT_TRUE(probe->texels.empty());
    }
    EXPECT_EQ(probe_image({}, "empty").error().id, "E-IMG-FORMAT");
}

TEST(ImageHeader, TheLimitsAreExact) {
    EXPECT_TRUE(check_image_size(65536, 1, 4, "E-IMG", "test"));
    EXPECT_TRUE(check_image_size(1, 65536, 4, "E-IMG", "test"));
    EXPECT_TRUE(check_image_size(65536, 8192, 4, "E-IMG", "test"));
    EXPECT_EQ(check_image_size(65536, 8193, 4, "E-IMG", "test").error().id, "E-IMG-LIMIT");
    EXPECT_EQ(check_image_size(65537, 1, 4, "E-IMG", "test").error().id, "E-IMG-LIMIT");
    EXPECT_TRUE(check_image_size(16384, 8192, 12, "E-ENV", "test"));
    EXPECT_EQ(check_image_size(32768, 16384, 12, "E-ENV", "test").error().id, "E-ENV-LIMIT");
    EXPECT_EQ(check_image_size(0, 5, 12, "E-ENV", "test").error().id, "E-ENV-CORRUPT");
    EXPECT_EQ(check_image_size(5, -5, 12, "E-ENV", "test").error().id, "E-ENV-CORRUPT");
}

TEST(ImageHeader, UnreadableProcessesAre69ByName) {
    const auto jpeg = [](unsigned marker, unsigned bits) {
        ByteVector bytes;
        append(bytes, {0xFF, 0xD8, 0xFF, marker, 0, 11, bits, 0, 8, 0, 8, 1, 1, 0x11, 0});
        bytes.resize(200);
        return bytes;
    };
    const Error twelve = error_of(jpeg(0xC1, 12));
    EXPECT_EQ(twelve.code, ExitCode::unsupported);
    EXPECT_EQ(twelve.id, "E-IMG-FEATURE");
    EXPECT_NE(twelve.message.find("12 bits"), std::string::npos);
    const Error lossless = error_of(jpeg(0xC3, 8));
    EXPECT_EQ(lossless.id, "E-IMG-FEATURE");
    EXPECT_NE(lossless.message.find("lossless"), std::string::npos);
}

TEST(ImageHeader, AThousandScansAreRefused) {
    ByteVector jpeg = jpeg_pattern(16, 16, 3);
    jpeg.resize(jpeg.size() - 2);
    for (int i = 0; i < 1001; ++i)
        append(jpeg, {0xFF, 0xDA, 0, 8, 1, 1, 0, 0, 63, 0});
    const Error error = error_of(jpeg);
    EXPECT_EQ(error.code, ExitCode::refused);
    EXPECT_EQ(error.id, "E-IMG-LIMIT");
}

TEST(ImageHeader, OtherFormatsAre67AndNamed) {
    const std::pair<const char*, const char*> others[] = {{"GIF89a", "GIF"},
                                                          {"BM123456", "BMP"},
                                                          {"8BPS", "Photoshop"},
                                                          {"DDS |", "DDS"},
                                                          {"<svg xmlns", "SVG"},
                                                          {"<!DOCTYPE html>", "HTML"},
                                                          {"#?RADIANCE", "Radiance"},
                                                          {"version https://git-lfs.g", "LFS"},
                                                          {"nonsense", "unknown"},
                                                          {"", "empty"}};
    for (const auto& [content, name] : others) {
        const Error error = error_of(to_bytes(content, std::strlen(content)));
        EXPECT_EQ(error.code, ExitCode::bad_resource);
        EXPECT_EQ(error.id, "E-IMG-FORMAT");
        EXPECT_NE(error.message.find(name), std::string::npos) << error.message;
        EXPECT_NE(error.message.find("PNG, JPEG, WebP and KTX2"), std::string::npos);
    }
}

TEST(ImageHeader, HeadersThatPromiseTooMuchAre77WithoutAllocating) {
    for (const auto& [width, height] :
         {std::pair{60000U, 60000U}, {65537U, 1U}, {1U, 65537U}, {0x7FFFFFFFU, 0x7FFFFFFFU}}) {
        const ByteVector png = PngBuilder(width, height, 8, 6).finish({{0}});
        const Error error = error_of(png);
        EXPECT_EQ(error.code, ExitCode::refused) << width;
        EXPECT_EQ(error.id, "E-IMG-LIMIT");
        EXPECT_NE(error.message.find(std::to_string(width)), std::string::npos);
        EXPECT_NE(error.message.find("65536"), std::string::npos);
        EXPECT_EQ(probe_image(png, "bomb").error().id, "E-IMG-LIMIT");
    }
    ByteVector jpeg;
    append(jpeg, {0xFF, 0xD8, 0xFF, 0xC0, 0, 11, 8, 0xFF, 0xFF, 0xFF, 0xFF, 1, 1, 0x11, 0});
    EXPECT_EQ(error_of(jpeg).id, "E-IMG-LIMIT");
}

TEST(ImageHeader, FewBytesThatPromiseALargeImageAre67) {
    EXPECT_EQ(error_of(PngBuilder(20000, 20000, 8, 6).finish({{0}})).id, "E-IMG-CORRUPT");
    ByteVector jpeg;
    append(jpeg, {0xFF, 0xD8, 0xFF, 0xC0, 0, 11, 8, 0x40, 0, 0x40, 0, 1, 1, 0x11, 0});
    EXPECT_EQ(error_of(jpeg).id, "E-IMG-CORRUPT");
}

TEST(ImageHeader, NoPixelsAre67) {
    EXPECT_EQ(error_of(PngBuilder(0, 0, 8, 6).finish({{0}})).id, "E-IMG-CORRUPT");
    EXPECT_EQ(error_of(PngBuilder(5, 0, 8, 6).finish({{0}})).id, "E-IMG-CORRUPT");
}

}  // namespace
}  // namespace obscura
