// tests/image/strip_metadata_test.cpp - metadata go, pixels and faults stay.
// SPDX-License-Identifier: Apache-2.0
#include "image/strip_metadata.h"

#include "image/decode.h"
#include "image/test_images.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using namespace testing_images;

bool contains(const ByteVector& bytes, std::string_view text) {
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return all.find(text) != std::string_view::npos;
}

TEST(WithoutMetadata, PngKeepsOnlyWhatMakesPixels) {
    const ByteVector png = PngBuilder(1, 1, 8, 3)
                               .chunk("gAMA", {0, 0, 0, 1})
                               .chunk("iCCP", {'x', 0, 0, 1, 2, 3})
                               .chunk("PLTE", {1, 2, 3})
                               .chunk("tRNS", {4})
                               .chunk("tEXt", {'a', 0, 'b'})
                               .finish({{0}});
    const ByteVector bare =
        PngBuilder(1, 1, 8, 3).chunk("PLTE", {1, 2, 3}).chunk("tRNS", {4}).finish({{0}});
    EXPECT_EQ(without_metadata(png, ImageFormat::png), bare);
}

TEST(WithoutMetadata, PngKeepsUnknownCriticalChunksAndTheCutOffEnd) {
    const ByteVector odd = PngBuilder(1, 1, 8, 0).chunk("CgBI", {1}).finish({{0}});
    EXPECT_EQ(without_metadata(odd, ImageFormat::png), odd);
    for (size_t size = 8; size < odd.size(); ++size) {
        const ByteVector cut(odd.begin(), odd.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_EQ(without_metadata(cut, ImageFormat::png), cut) << size;
    }
}

TEST(WithoutMetadata, JpegLosesExifProfilesAndCommentsButNotJfif) {
    const ByteVector plain = without_metadata(jpeg_pattern(16, 16, 3), ImageFormat::jpeg);
    ByteVector jpeg(plain.begin(), plain.begin() + 2);
    append(jpeg, {0xFF, 0xE1, 0, 8, 'E', 'x', 'i', 'f', 0, 0});
    append(jpeg, {0xFF, 0xE2, 0, 6, 'I', 'C', 'C', '_'});
    append(jpeg, {0xFF, 0xFE, 0, 6, 'n', 'o', 't', 'e'});
    jpeg.insert(jpeg.end(), plain.begin() + 2, plain.end());
    EXPECT_EQ(without_metadata(jpeg, ImageFormat::jpeg), plain);
    EXPECT_TRUE(contains(plain, "JFIF"));
}

TEST(WithoutMetadata, DamagedMetadataDoNotMatter) {
    Log log(Verbosity::quiet);
    const ByteVector png = PngBuilder(1, 1, 8, 0).chunk("iCCP", {9, 9, 9}).finish({{77}});
    const Result<ImageRgba8> from_png = decode_image(png, "profile.png", log);
    ASSERT_TRUE(from_png);
    EXPECT_EQ(from_png->texels[0], 0xFF4D4D4DU);

    const ByteVector plain = jpeg_pattern(16, 16, 3);
    ByteVector jpeg(plain.begin(), plain.begin() + 2);
    append(jpeg, {0xFF, 0xE1, 0, 14, 'E', 'x', 'i', 'f', 0, 0, 'I', 'I', '*', 0, 0xFF, 0xFF});
    append(jpeg, {0xFF, 0xE2, 0, 16});
    append_text(jpeg, "ICC_PROFILE");
    append(jpeg, {0, 0x7F, 0x01});
    jpeg.insert(jpeg.end(), plain.begin() + 2, plain.end());
    const Result<ImageRgba8> from_jpeg = decode_image(jpeg, "profile.jpg", log);
    ASSERT_TRUE(from_jpeg) << from_jpeg.error().message;
    EXPECT_EQ(from_jpeg->texels, decode_image(plain, "plain.jpg", log)->texels);
    EXPECT_TRUE(log.warnings().empty());
}

TEST(WithoutMetadata, WebpIsCopied) {
    const ByteVector webp = webp_pattern(8, 8, true);
    EXPECT_EQ(without_metadata(webp, ImageFormat::webp), webp);
}

}  // namespace
}  // namespace obscura
