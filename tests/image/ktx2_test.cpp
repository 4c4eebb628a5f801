// tests/image/ktx2_test.cpp - KTX2 files: another program's, our own, wrong ones, damaged ones.
// SPDX-License-Identifier: Apache-2.0
#include "image/ktx2.h"

#include "image/decode.h"
#include "image/ktx2_builder.h"
#include "image/ktx2_files.h"
#include "image/texel_hash.h"

#include <gtest/gtest.h>

#include <zstd.h>

namespace obscura {
namespace {

using namespace testing_images;

Result<ImageRgba8> read(const ByteVector& bytes, Log& log) {
    return decode_image(bytes, "scene.gltf#/images/3", log, Extent::stored);
}

ImageRgba8 decoded(const ByteVector& bytes) {
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = read(bytes, log);
    EXPECT_TRUE(image) << image.error().id << " " << image.error().message;
    EXPECT_TRUE(log.warnings().empty()) << log.warnings().front();
    return image.value_or(ImageRgba8{});
}

Error error_of(const ByteVector& bytes) {
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> image = read(bytes, log);
    EXPECT_FALSE(image) << "decoded although it must not";
    return image ? Error{} : image.error();
}

std::string id_of(const ByteVector& bytes) {
    const Error error = error_of(bytes);
    EXPECT_EQ(error.where, "scene.gltf#/images/3");
    return std::to_string(static_cast<int>(error.code)) + " " + error.id;
}

/// An image of one texel, `channels` bytes.
Ktx2Parts plain(uint32_t format, std::initializer_list<unsigned> texel) {
    Ktx2Parts parts;
    parts.format = format;
    parts.levels.emplace_back();
    append(parts.levels.back(), texel);
    return parts;
}

/// One block of solid colour (r, g, b, a) = (0x11, 0x22, 0x33, 0x44).
Ktx2Parts uastc(uint32_t channel) {
    Ktx2Parts parts;
    parts.format = 0;
    parts.model = 166;
    parts.channels = {channel};
    parts.width = parts.height = 4;
    parts.levels.emplace_back();
    append_little_endian(parts.levels.back(), 0x44332211ULL << 5 | 0b10111, 16);
    return parts;
}

ByteVector with_zstd(const ByteVector& bytes) {
    ByteVector out(ZSTD_compressBound(bytes.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
    return out;
}

/// The image that the three files were made from, outside its noisy lower right quarter.
double mean_difference(const ImageRgba8& image, bool has_alpha) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (2 * x > image.width && 2 * y > image.height) continue;
            const bool tile = ((x / 8 ^ y / 8) & 1) != 0;
            const double expected[] = {255.0 * x / (image.width - 1),
                                       255.0 * y / (image.height - 1),
                                       tile ? 200.0 : 40.0,
                                       has_alpha && tile ? 255.0 - 3 * x : 255.0};
            const size_t at =
                static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x);
            for (size_t c = 0; c < 4; ++c, ++count)
                sum += std::abs(expected[c] - (image.texels[at] >> 8 * c & 0xFFU));
        }
    }
    return sum / count;
}

/// Hashes: of all levels, as Binomial's transcoder (in three.js r160) decodes them to RGBA32.
TEST(Ktx2, FilesOfAnotherEncoderAsAnotherDecoderSeesThem) {
    const ImageRgba8 rgba = decoded(from_hex(ktx2_etc1s_rgba));
    EXPECT_EQ(rgba.width, 32);
    EXPECT_EQ(rgba.height, 24);
    EXPECT_EQ(rgba.levels, 6);
    EXPECT_EQ(rgba.format, "ktx2");
    EXPECT_EQ(rgba.encoding, ImageEncoding::srgb);
    EXPECT_EQ(rgba.texels.size(), 32U * 24 + 16 * 12 + 8 * 6 + 4 * 3 + 2 + 1);
    EXPECT_EQ(texel_hash(rgba.texels), 0x7B26437C6F30B6AFULL);
    EXPECT_LT(mean_difference(rgba, true), 12);

    const ImageRgba8 rgb = decoded(from_hex(ktx2_etc1s_rgb));
    EXPECT_EQ(rgb.levels, 1);
    EXPECT_EQ(rgb.encoding, ImageEncoding::linear);
    EXPECT_EQ(texel_hash(rgb.texels), 0x551152DB999207E5ULL);
    EXPECT_LT(mean_difference(rgb, false), 16);

    const ImageRgba8 uastc = decoded(from_hex(ktx2_uastc_zstd));
    EXPECT_EQ(uastc.levels, 5);
    EXPECT_EQ(texel_hash(uastc.texels), 0x76594DE9420E1CBEULL);
    EXPECT_LT(mean_difference(uastc, true), 4);
}

TEST(Ktx2, TheBaseLevelAloneIsTheFirstOfAll) {
    const ByteVector bytes = from_hex(ktx2_etc1s_rgba);
    Log log(Verbosity::quiet);
    const Result<ImageRgba8> base = decode_image(bytes, "x", log);
    ASSERT_TRUE(base);
    EXPECT_EQ(base->levels, 1);
    std::vector<uint32_t> texels = decoded(bytes).texels;
    texels.resize(32U * 24);
    EXPECT_EQ(base->texels, texels);
    const Result<ImageRgba8> probed = probe_image(bytes, "x");
    ASSERT_TRUE(probed);
    EXPECT_EQ(probed->levels, 6);
    EXPECT_EQ(probed->width, 32);
    EXPECT_EQ(probed->encoding, ImageEncoding::srgb);
    EXPECT_TRUE(probed->texels.empty());
}

TEST(Ktx2, PlainFormatsWithAndWithoutZstandard) {
    const auto texel = [](Ktx2Parts parts) {
        const uint32_t stored = decoded(ktx2_file(parts)).texels.at(0);
        parts.uncompressed_bytes = parts.levels[0].size();
        parts.levels[0] = with_zstd(parts.levels[0]);
        parts.scheme = 2;
        EXPECT_EQ(decoded(ktx2_file(parts)).texels.at(0), stored);
        return stored;
    };
    EXPECT_EQ(texel(plain(37, {1, 2, 3, 4})), 0x04030201U);
    EXPECT_EQ(texel(plain(43, {1, 2, 3, 4})), 0x04030201U);
    EXPECT_EQ(texel(plain(23, {1, 2, 3})), 0xFF030201U);
    EXPECT_EQ(texel(plain(29, {1, 2, 3})), 0xFF030201U);
    EXPECT_EQ(texel(plain(16, {1, 2})), 0xFF000201U);
    EXPECT_EQ(texel(plain(9, {1})), 0xFF010101U);
}

TEST(Ktx2, ChannelsOfUastc) {
    const auto texel = [](uint32_t channel) {
        return decoded(ktx2_file(uastc(channel))).texels.at(15);
    };
    EXPECT_EQ(texel(0), 0xFF332211U);  // RGB
    EXPECT_EQ(texel(3), 0x44332211U);  // RGBA
    EXPECT_EQ(texel(4), 0xFF111111U);  // RRR
    EXPECT_EQ(texel(5), 0xFF004411U);  // RRRG
    EXPECT_EQ(texel(6), 0xFF002211U);  // RG
    EXPECT_EQ(id_of(ktx2_file(uastc(1))), "69 E-IMG-FEATURE");
}

/// The file's two slices are grey alpha and colour; declared as red and green they are read so.
TEST(Ktx2, ChannelsOfEtc1s) {
    ByteVector bytes = from_hex(ktx2_etc1s_rgba);
    const std::vector<uint32_t> rgba = decoded(bytes).texels;
    const size_t description = 80 + 6 * 24;
    const auto set_channels = [&](unsigned first, unsigned second) {
        bytes[description + 28 + 3] = static_cast<std::byte>(first);
        bytes[description + 28 + 16 + 3] = static_cast<std::byte>(second);
    };
    set_channels(3, 4);
    const std::vector<uint32_t> red_green = decoded(bytes).texels;
    for (size_t i = 0; i < rgba.size(); ++i) {
        const uint32_t green = rgba[i] >> 24 << 8;
        ASSERT_EQ(red_green[i], 0xFF000000U | green | (rgba[i] & 0xFFU)) << i;
    }
    set_channels(0, 4);
    EXPECT_EQ(id_of(bytes), "69 E-IMG-FEATURE");
}

TEST(Ktx2, WhatGltfForbidsButCanBeReadWarns) {
    const auto warning = [](const Ktx2Parts& parts) {
        Log log(Verbosity::quiet);
        EXPECT_TRUE(read(ktx2_file(parts), log));
        return log.warnings().empty() ? std::string() : log.warnings().front();
    };
    Ktx2Parts parts = plain(37, {1, 2, 3, 4});
    parts.key_values = {{"KTXorientation", "rd"}, {"KTXswizzle", "rgba"}, {"KTXwriter", "me"}};
    EXPECT_EQ(warning(parts), "");
    parts.flags = 1;
    EXPECT_NE(warning(parts).find("premultiplied"), std::string::npos);
    parts.flags = 0;
    parts.primaries = 10;
    EXPECT_NE(warning(parts).find("primaries"), std::string::npos);
}

TEST(Ktx2, OtherShapesAreNamed) {
    const auto refuses = [](Ktx2Parts parts, const std::string& name) {
        const Error error = error_of(ktx2_file(parts));
        EXPECT_EQ(error.code, ExitCode::unsupported);
        EXPECT_EQ(error.id, "E-IMG-FEATURE");
        EXPECT_NE(error.message.find(name), std::string::npos) << error.message;
    };
    Ktx2Parts parts = plain(37, {1, 2, 3, 4});
    parts.depth = 1;
    refuses(parts, "3D texture");
    parts.depth = 0;
    parts.layers = 2;
    refuses(parts, "array");
    parts.faces = 6;
    refuses(parts, "cube map");
    parts.faces = 1;
    parts.layers = 0;
    parts.height = 0;
    refuses(parts, "1D");
    parts.height = 1;
    parts.key_values = {{"KTXorientation", "ru"}};
    refuses(parts, "KTXorientation is \"ru\"; accepted is \"rd\"");
    parts.key_values = {{"KTXswizzle", "rrr1"}};
    refuses(parts, "KTXswizzle");
    parts.key_values.clear();
    parts.format = 97;
    refuses(parts, "Vulkan format 97");
    parts.format = 37;
    parts.scheme = 3;
    refuses(parts, "supercompression 3");
}

TEST(Ktx2, AFrameOfAVideoIsRefused) {
    ByteVector bytes = from_hex(ktx2_etc1s_rgb);
    const size_t global = std::to_integer<size_t>(bytes[64]) | std::to_integer<size_t>(bytes[65])
                                                                   << 8;
    bytes[global + 20] = std::byte{2};
    EXPECT_EQ(id_of(bytes), "69 E-IMG-FEATURE");
}

TEST(Ktx2, SizesThatContradictAreRefused) {
    Ktx2Parts parts = plain(37, {1, 2, 3, 4});
    parts.faces = 2;
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
    parts.faces = 1;
    parts.width = 2;
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
    parts.width = 0;
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
    parts.width = 100000;
    EXPECT_EQ(id_of(ktx2_file(parts)), "77 E-IMG-LIMIT");
    parts.width = parts.height = 65536;
    EXPECT_EQ(id_of(ktx2_file(parts)), "77 E-IMG-LIMIT");
    parts.width = parts.height = 1;
    parts.level_count = 2;
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
    parts.level_count = 0;  // as one
    EXPECT_EQ(decoded(ktx2_file(parts)).texels.at(0), 0x04030201U);
}

/// A few bytes cannot promise half a gigabyte, whatever the index says.
TEST(Ktx2, ZstandardIsMeasuredBeforeItIsInflated) {
    Ktx2Parts parts = uastc(3);
    parts.levels[0] = with_zstd(parts.levels[0]);
    parts.scheme = 2;
    parts.uncompressed_bytes = 16;
    EXPECT_EQ(decoded(ktx2_file(parts)).texels.at(0), 0x44332211U);
    parts.uncompressed_bytes = 32;
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
    parts.width = 8;  // 32 bytes are asked for, and 16 come
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
    parts.width = parts.height = 16384;
    parts.uncompressed_bytes = 16384ULL * 16384;
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
}

TEST(Ktx2, ABlockOfNoModeIsRefused) {
    Ktx2Parts parts = uastc(3);
    parts.levels[0][0] = std::byte{0b1000101};
    EXPECT_EQ(id_of(ktx2_file(parts)), "67 E-IMG-CORRUPT");
}

/// Cut off anywhere, or with a byte changed: an error or an image, never a crash.
TEST(Ktx2, DamageIsFoundOrHarmless) {
    Ktx2Parts parts = plain(37, {1, 2, 3, 4});
    parts.key_values = {{"KTXorientation", "rd"}};
    for (const ByteVector& whole : {from_hex(ktx2_etc1s_rgba),
                                    from_hex(ktx2_etc1s_rgb),
                                    from_hex(ktx2_uastc_zstd),
                                    ktx2_file(parts)}) {
        Log log(Verbosity::quiet);
        for (size_t size = 0; size < whole.size(); ++size) {
            const ByteVector cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            const Result<ImageRgba8> image = read(cut, log);
            ASSERT_FALSE(image) << size;
            EXPECT_EQ(image.error().code, ExitCode::bad_resource) << size;
        }
        for (size_t at = 0; at < whole.size(); ++at) {
            for (const unsigned flip : {0x04U, 0xFFU}) {
                ByteVector changed = whole;
                changed[at] ^= static_cast<std::byte>(flip);
                const Result<ImageRgba8> image = read(changed, log);
                EXPECT_TRUE(image || image.error().code != ExitCode::internal) << at;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
