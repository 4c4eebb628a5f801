// tests/image/environment_test.cpp - environments of every format, whole, odd and broken.
// SPDX-License-Identifier: Apache-2.0
#include "image/decode.h"
#include "image/test_images.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <cmath>
#include <limits>
#include <sys/stat.h>

namespace obscura {
namespace {

using namespace testing_images;

/// Float values that half holds exactly, all different: (pixel + channel / 4).
std::vector<float> ramp(int width, int height, int channels) {
    std::vector<float> values;
    for (int i = 0; i < width * height; ++i) {
        for (int c = 0; c < channels; ++c) {
            values.push_back(static_cast<float>(i % 256) + 0.25f * static_cast<float>(c));
        }
    }
    return values;
}

class Environment : public FolderTest {
protected:
    std::filesystem::path write_exr(const std::vector<std::string>& channels,
                                    const std::vector<float>& values,
                                    OIIO::TypeDesc type = OIIO::TypeDesc::HALF,
                                    int width = 8,
                                    int tile = 0) {
        const std::filesystem::path file = folder_ / "env.exr";
        const int count = static_cast<int>(channels.size());
        OIIO::ImageSpec spec(width, width / 2, count, type);
        spec.channelnames = channels;
        spec.tile_width = spec.tile_height = tile;
        const auto output = OIIO::ImageOutput::create(file.string());
        EXPECT_TRUE(output && output->open(file.string(), spec) &&
                    output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close())
            << OIIO::geterror();
        return file;
    }

    std::filesystem::path write_hdr(int width, int height, const std::vector<float>& values) {
        const std::filesystem::path file = folder_ / "env.hdr";
        const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::FLOAT);
        const auto output = OIIO::ImageOutput::create(file.string());
        EXPECT_TRUE(output && output->open(file.string(), spec) &&
                    output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close())
            << OIIO::geterror();
        return file;
    }

    ImageRgb32f read(const std::filesystem::path& file) {
        const Result<ImageRgb32f> image = read_environment(file, log_);
        EXPECT_TRUE(image) << image.error().id << " " << image.error().message;
        return image.value_or(ImageRgb32f{});
    }

    Error error_of(const std::filesystem::path& file) {
        const Result<ImageRgb32f> image = read_environment(file, log_);
        EXPECT_FALSE(image) << file << " was read although it must not";
        if (image) return {};
        EXPECT_EQ(image.error().where, file.string());
        EXPECT_FALSE(image.error().message.empty());
        return image.error();
    }

    Log log_{Verbosity::quiet};
};

TEST_F(Environment, ExrHalfAndFloat) {
    for (const auto type : {OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT}) {
        const ImageRgb32f image = read(write_exr({"R", "G", "B"}, ramp(8, 4, 3), type));
        EXPECT_EQ(image.width, 8);
        EXPECT_EQ(image.height, 4);
        EXPECT_EQ(image.pixels, ramp(8, 4, 3));
    }
    EXPECT_TRUE(log_.warnings().empty());
}

TEST_F(Environment, ExrTiled) {
    EXPECT_EQ(
        read(write_exr({"R", "G", "B"}, ramp(64, 32, 3), OIIO::TypeDesc::HALF, 64, 16)).pixels,
        ramp(64, 32, 3));
}

/// OpenEXR would allocate them before it has read anything.
TEST_F(Environment, ExrTilesBeyondAllSizesAre67) {
    const std::filesystem::path file =
        write_exr({"R", "G", "B"}, ramp(64, 32, 3), OIIO::TypeDesc::HALF, 64, 16);
    std::string bytes = read_whole_file(file);
    const std::string name("tiles\0tiledesc\0", 15);
    const size_t value = bytes.find(name) + name.size() + 4;
    ASSERT_LT(value, bytes.size());
    bytes[value + 2] = 0x10;  // a width of 16 becomes one of a million
    std::ofstream(file, std::ios::binary) << bytes;
    const Error error = error_of(file);
    EXPECT_EQ(error.code, ExitCode::bad_resource);
    EXPECT_EQ(error.id, "E-ENV-CORRUPT");
    EXPECT_NE(error.message.find("65536"), std::string::npos) << error.message;
}

TEST_F(Environment, ExrAlphaAndOtherChannelsAreIgnored) {
    const ImageRgb32f image = read(write_exr({"R", "G", "B", "A", "Z"}, ramp(8, 4, 5)));
    for (size_t i = 0; i < 32; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(image.pixels[3 * i + c],
                      static_cast<float>(i) + 0.25f * static_cast<float>(c));
        }
    }
}

TEST_F(Environment, ExrLuminanceBecomesGrey) {
    const ImageRgb32f image = read(write_exr({"Y"}, ramp(8, 4, 1)));
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        ASSERT_EQ(image.pixels[i], static_cast<float>(i / 3));
    }
}

TEST_F(Environment, ExrFirstLayerWithColourIsUsed) {
    const ImageRgb32f image = read(write_exr(
        {"View.Depth.Z", "View.Combined.R", "View.Combined.G", "View.Combined.B"}, ramp(8, 4, 4)));
    EXPECT_EQ(image.pixels[0], 0.25f);
    EXPECT_EQ(image.pixels[2], 0.75f);
}

TEST_F(Environment, ExrWithoutColourIs67AndListsItsChannels) {
    const Error error = error_of(write_exr({"Z", "mask"}, ramp(8, 4, 2)));
    EXPECT_EQ(error.code, ExitCode::bad_resource);
    EXPECT_EQ(error.id, "E-ENV-CORRUPT");
    EXPECT_NE(error.message.find("mask"), std::string::npos) << error.message;
}

TEST_F(Environment, ExrSubsampledColourIs67) {
    const std::filesystem::path file = folder_ / "sub.exr";
    {
        Imf::Header header(8, 4);
        for (const char* name : {"R", "G", "B"}) {
            header.channels().insert(name, Imf::Channel(Imf::HALF, 2, 2));
        }
        Imf::OutputFile output(file.c_str(), header);
        std::vector<char> zeros(64);
        Imf::FrameBuffer buffer;
        for (const char* name : {"R", "G", "B"}) {
            buffer.insert(name, Imf::Slice(Imf::HALF, zeros.data(), 2, 8, 2, 2));
        }
        output.setFrameBuffer(buffer);
        output.writePixels(4);
    }
    EXPECT_NE(error_of(file).message.find("subsampled"), std::string::npos);
}

TEST_F(Environment, ExrOfOtherPrimariesIsAWarning) {
    const std::filesystem::path file = folder_ / "ap1.exr";
    for (const bool rec709 : {true, false}) {
        {
            Imf::Header header(8, 4);
            for (const char* name : {"R", "G", "B"})
                header.channels().insert(name, Imf::Channel());
            Imf::Chromaticities primaries;
            if (!rec709) primaries.red = Imath::V2f(0.713f, 0.293f);
            Imf::addChromaticities(header, primaries);
            Imf::OutputFile output(file.c_str(), header);
            output.setFrameBuffer(Imf::FrameBuffer());
            output.writePixels(4);
        }
        read(file);
        EXPECT_EQ(log_.warnings().size(), rec709 ? 0U : 1U);
    }
}

TEST_F(Environment, RadianceHdr) {
    std::vector<float> values;
    for (int i = 0; i < 32 * 16; ++i) {
        const float value = std::exp2(static_cast<float>(i % 20 - 8));
        values.insert(values.end(), {value, value / 2, value / 4});
    }
    const ImageRgb32f image = read(write_hdr(32, 16, values));
    ASSERT_EQ(image.width, 32);
    ASSERT_EQ(image.height, 16);
    for (size_t i = 0; i < values.size(); ++i) {
        ASSERT_NEAR(image.pixels[i] / values[i], 1.0f, 0.01f) << i;
    }
}

TEST_F(Environment, EightBitImagesAreDecodedFromSrgb) {
    const std::filesystem::path file = folder_ / "env.png";
    write_bytes(file, PngBuilder(2, 1, 8, 2).finish({{0, 10, 188, 255, 11, 128}}));
    const ImageRgb32f image = read(file);
    const double codes[] = {0, 10, 188, 255, 11, 128};
    for (size_t i = 0; i < 6; ++i) {
        const double code = codes[i] / 255;
        const double linear =
            code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(image.pixels[i], linear, 1e-6) << i;
    }
}

TEST_F(Environment, FormatIsToldByContentNotByName) {
    write_exr({"R", "G", "B"}, ramp(8, 4, 3));
    std::filesystem::rename(folder_ / "env.exr", folder_ / "env.png");
    EXPECT_EQ(read(folder_ / "env.png").pixels, ramp(8, 4, 3));
}

TEST_F(Environment, BadValuesAreReplacedAndCountedInOneWarning) {
    std::vector<float> values = ramp(8, 4, 3);
    values[3] = -1;
    values[4] = std::numeric_limits<float>::quiet_NaN();
    values[5] = std::numeric_limits<float>::infinity();
    values[6] = -std::numeric_limits<float>::infinity();
    values[7] = 1e30f;
    values[8] = -0.0f;
    const ImageRgb32f image = read(write_exr({"R", "G", "B"}, values, OIIO::TypeDesc::FLOAT));
    EXPECT_EQ(image.pixels[3], 0);
    EXPECT_EQ(image.pixels[4], 0);
    EXPECT_EQ(image.pixels[5], 65504);
    EXPECT_EQ(image.pixels[6], 0);
    EXPECT_EQ(image.pixels[7], 1e30f);
    EXPECT_EQ(image.pixels[9], values[9]);
    ASSERT_EQ(log_.warnings().size(), 1U);
    EXPECT_NE(log_.warnings()[0].find(" 4 of 96 values"), std::string::npos) << log_.warnings()[0];
}

TEST_F(Environment, WhatCannotBeOpenedIs67AndNeverWaits) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    for (const std::filesystem::path& file :
         {folder_ / "absent.exr", folder_, folder_ / "pipe", std::filesystem::path("/dev/zero")}) {
        const Error error = error_of(file);
        EXPECT_EQ(error.code, ExitCode::bad_resource);
        EXPECT_EQ(error.id, "E-ENV-MISSING") << file;
    }
}

TEST_F(Environment, OtherFormatsAre67AndNamed) {
    for (const char* content : {"", "GIF89a", "<html>", "random bytes"}) {
        write_bytes(folder_ / "odd.hdr", to_bytes(content, std::strlen(content)));
        const Error error = error_of(folder_ / "odd.hdr");
        EXPECT_EQ(error.code, ExitCode::bad_resource);
        EXPECT_EQ(error.id, "E-ENV-FORMAT");
        EXPECT_NE(error.message.find("OpenEXR"), std::string::npos);
    }
}

TEST_F(Environment, WhatIsNotReadOfAFormatIs69) {
    ByteVector lossless;  // a JPEG's header by another method
    append(lossless, {0xFF, 0xD8, 0xFF, 0xC3, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0});
    lossless.resize(200);
    write_bytes(folder_ / "lossless.jpg", lossless);
    const Error error = error_of(folder_ / "lossless.jpg");
    EXPECT_EQ(error.id, "E-ENV-FEATURE");
    EXPECT_EQ(error.code, ExitCode::unsupported);
}

TEST_F(Environment, OtherAspectsAre65) {
    write_hdr(9, 4, std::vector<float>(9 * 4 * 3, 1.0f));
    EXPECT_EQ(error_of(folder_ / "env.hdr").code, ExitCode::bad_data);
    EXPECT_EQ(error_of(folder_ / "env.hdr").id, "E-ENV-ASPECT");
    EXPECT_EQ(error_of(write_exr({"R", "G", "B"}, ramp(9, 4, 3), OIIO::TypeDesc::HALF, 9)).id,
              "E-ENV-ASPECT");
    write_bytes(folder_ / "square.png", png_pattern(4, 4, 3));
    EXPECT_EQ(error_of(folder_ / "square.png").id, "E-ENV-ASPECT");
}

TEST_F(Environment, CutOffFilesAre67WhereverTheyEnd) {
    write_exr({"R", "G", "B"}, ramp(64, 32, 3), OIIO::TypeDesc::HALF, 64);
    write_hdr(64, 32, ramp(64, 32, 3));
    write_bytes(folder_ / "env.png", png_pattern(64, 32, 3));
    write_bytes(folder_ / "env.jpg", jpeg_pattern(64, 32, 3));
    for (const char* name : {"env.exr", "env.hdr", "env.png", "env.jpg"}) {
        const ByteVector whole = read_bytes(folder_ / name);
        read(folder_ / name);
        for (size_t tenth = 1; tenth < 10; ++tenth) {
            ByteVector cut = whole;
            cut.resize(whole.size() * tenth / 10);
            write_bytes(folder_ / "cut", cut);
            const Error error = error_of(folder_ / "cut");
            EXPECT_EQ(error.code, ExitCode::bad_resource) << name << " " << tenth;
            EXPECT_EQ(error.id, "E-ENV-CORRUPT") << name << " " << tenth;
        }
    }
}

TEST_F(Environment, RadianceHeadersAreCheckedBeforeAnythingIsAllocated) {
    struct Case {
        const char* size_line;
        const char* id;
    };
    const Case cases[] = {{"-Y 99999999 +X 199999998\n", "E-ENV-LIMIT"},
                          {"-Y 99999999999999999999 +X 2\n", "E-ENV-LIMIT"},
                          {"-Y 30000 +X 60000\n", "E-ENV-LIMIT"},
                          {"-Y 4 +X 9\n", "E-ENV-ASPECT"},
                          {"-Y 0 +X 0\n", "E-ENV-CORRUPT"},
                          {"-Y -4 +X -8\n", "E-ENV-CORRUPT"},
                          {"+X 8 -Y 4\n", "E-ENV-CORRUPT"},
                          {"", "E-ENV-CORRUPT"}};
    for (const Case& c : cases) {
        const std::string text =
            std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n") + c.size_line + "abcd";
        write_bytes(folder_ / "bomb.hdr", to_bytes(text.data(), text.size()));
        EXPECT_EQ(error_of(folder_ / "bomb.hdr").id, c.id) << c.size_line;
    }
    EXPECT_EQ(error_of(folder_ / "bomb.hdr").code, ExitCode::bad_resource);
}

TEST_F(Environment, ExrHeadersAreCheckedBeforeAnythingIsAllocated) {
    const ByteVector whole = read_bytes(write_exr({"R", "G", "B"}, ramp(8, 4, 3)));
    const std::string_view text(reinterpret_cast<const char*>(whole.data()), whole.size());
    const size_t window = text.find("dataWindow") + sizeof "dataWindow" + sizeof "box2i" + 4;
    struct Case {
        int32_t right;
        int32_t bottom;
        const char* id;
    };
    const Case cases[] = {{59999, 29999, "E-ENV-LIMIT"},
                          {INT32_MAX, INT32_MAX, "E-ENV-LIMIT"},
                          {0, INT32_MAX, "E-ENV-LIMIT"},
                          {8, 3, "E-ENV-ASPECT"},
                          {-5, -5, "E-ENV-CORRUPT"}};
    for (const Case& c : cases) {
        ByteVector bomb = whole;
        std::memcpy(bomb.data() + window + 8, &c.right, 4);
        std::memcpy(bomb.data() + window + 12, &c.bottom, 4);
        write_bytes(folder_ / "bomb.exr", bomb);
        const Error error = error_of(folder_ / "bomb.exr");
        EXPECT_EQ(error.id, c.id) << c.right;
        EXPECT_EQ(error.code == ExitCode::refused, error.id == "E-ENV-LIMIT");
    }
    for (size_t size = 4; size < window; size += 7) {
        write_bytes(folder_ / "cut.exr",
                    ByteVector(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
        EXPECT_EQ(error_of(folder_ / "cut.exr").id, "E-ENV-CORRUPT") << size;
    }
}

}  // namespace
}  // namespace obscura
