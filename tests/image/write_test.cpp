// tests/image/write_test.cpp - EXR, PNG and JPEG files read back, metadata, and failing disks.
// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include "base/parallel.h"
#include "image/decode.h"
#include "image/test_images.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <sys/resource.h>

namespace obscura {
namespace {

using namespace testing_images;

/// Values that half holds exactly, some above 1 and some negative.
OutputImage image_of(int width, int height, std::vector<std::string> channels) {
    OutputImage image{width, height, std::move(channels), {}};
    const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
    for (size_t i = 0; i < count * image.channels.size(); ++i) {
        image.pixels.push_back(static_cast<float>(i % 2000) / 64 - 1);
    }
    return image;
}

OutputImage one_pixel(std::vector<std::string> channels, UnsetArray<float> values) {
    return OutputImage{1, 1, std::move(channels), std::move(values)};
}

ImageMetadata full_metadata() {
    ImageMetadata metadata;
    metadata.software = "Obscura 0.1.0";
    metadata.asset = "Helmet.glb";
    metadata.copyright = "2016, someone";
    metadata.samples_per_pixel = 64;
    metadata.seed = 0xFFFFFFFFFFFFFFFFULL;
    metadata.extra = {{"obscura:integrator", "path"}, {"host", "render\x1B[31mnode"}};
    return metadata;
}

std::map<std::string, std::vector<float>> channels_of(Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow();
    const int width = window.max.x - window.min.x + 1;
    const int height = window.max.y - window.min.y + 1;
    std::map<std::string, std::vector<float>> values;
    Imf::FrameBuffer buffer;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) {
        std::vector<float>& channel = values[c.name()];
        channel.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
        buffer.insert(c.name(),
                      Imf::Slice::Make(Imf::FLOAT, channel.data(), window.min, width, height));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return values;
}

std::string text_of(const Imf::Header& header, const char* name) {
    const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
    return attribute ? attribute->value() : "(no " + std::string(name) + ")";
}

class WriteImage : public FolderTest {
protected:
    void write(const std::string& name,
               const OutputImage& image,
               const ImageMetadata& metadata = full_metadata(),
               ExrDepth depth = ExrDepth::half,
               const DisplayEncoding& encoding = {}) {
        const auto written =
            write_image_file(folder_ / name, image, metadata, {.depth = depth}, encoding);
        ASSERT_TRUE(written) << written.error().message;
    }

    Error error_of(const std::filesystem::path& file, const OutputImage& image) {
        const auto written = write_image_file(file, image, full_metadata(), {}, {});
        EXPECT_FALSE(written) << file;
        return written ? Error{} : written.error();
    }

    std::vector<uint32_t> texels(const std::string& name) {
        const Result<ImageRgba8> image = decode_image(read_bytes(folder_ / name), name, log_);
        EXPECT_TRUE(image) << image.error().message;
        return image ? image->texels : std::vector<uint32_t>();
    }

    DisplayTransform display_of(const char* view) {
        Result<DisplayTransform> display =
            DisplayTransform::create(DisplayOptions{{}, {}, view, 0}, log_);
        EXPECT_TRUE(display);
        return std::move(*display);
    }

    Log log_{Verbosity::quiet};
};

TEST_F(WriteImage, ExrKeepsEveryValueInBothDepths) {
    const OutputImage image = image_of(37, 21, {"R", "G", "B", "A"});
    for (const ExrDepth depth : {ExrDepth::half, ExrDepth::float32}) {
        write("out.exr", image, full_metadata(), depth);
        Imf::InputFile file((folder_ / "out.exr").c_str());
        const Imf::Header& header = file.header();
        EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
        EXPECT_EQ(header.dataWindow(), Imath::Box2i({0, 0}, {36, 20}));
        EXPECT_EQ(header.displayWindow(), header.dataWindow());
        const Imf::PixelType type = depth == ExrDepth::half ? Imf::HALF : Imf::FLOAT;
        const auto channels = channels_of(file);
        ASSERT_EQ(channels.size(), 4U);
        for (size_t c = 0; c < 4; ++c) {
            const std::string& name = image.channels[c];
            EXPECT_EQ(header.channels().findChannel(name)->type, type);
            for (size_t i = 0; i < channels.at(name).size(); ++i) {
                ASSERT_EQ(channels.at(name)[i], image.pixels[4 * i + c]) << name << " " << i;
            }
        }
    }
}

TEST_F(WriteImage, ExrTellsWhereItComesFrom) {
    write("out.exr", image_of(4, 4, {"R", "G", "B", "A"}));
    const Imf::InputFile file((folder_ / "out.exr").c_str());
    const Imf::Header& header = file.header();
    EXPECT_EQ(text_of(header, "Software"), "Obscura 0.1.0");
    EXPECT_EQ(text_of(header, "obscura:asset"), "Helmet.glb");
    EXPECT_EQ(text_of(header, "copyright"), "2016, someone");
    EXPECT_EQ(Imf::owner(header), "2016, someone");
    EXPECT_EQ(text_of(header, "obscura:seed"), "18446744073709551615");
    EXPECT_EQ(text_of(header, "colorInteropID"), "lin_rec709_scene");
    EXPECT_EQ(text_of(header, "obscura:integrator"), "path");
    EXPECT_EQ(text_of(header, "host"), "render\\x1b[31mnode");
    EXPECT_EQ(header.typedAttribute<Imf::IntAttribute>("obscura:samplesPerPixel").value(), 64);
    const Imf::Chromaticities& found =
        header.typedAttribute<Imf::ChromaticitiesAttribute>("chromaticities").value();
    EXPECT_EQ(found.red, Imath::V2f(0.64f, 0.33f));
    EXPECT_EQ(found.green, Imath::V2f(0.30f, 0.60f));
    EXPECT_EQ(found.blue, Imath::V2f(0.15f, 0.06f));
    EXPECT_EQ(found.white, Imath::V2f(0.3127f, 0.3290f));
}

TEST_F(WriteImage, DataAreNotCalledColour) {
    ImageMetadata metadata;
    metadata.is_color = false;
    write(
        "data.exr", image_of(4, 4, {"Z", "N.X", "N.Y", "N.Z", "id"}), metadata, ExrDepth::float32);
    Imf::InputFile file((folder_ / "data.exr").c_str());
    EXPECT_EQ(text_of(file.header(), "colorInteropID"), "data");
    EXPECT_FALSE(Imf::hasChromaticities(file.header()));
    EXPECT_EQ(file.header().findTypedAttribute<Imf::StringAttribute>("copyright"), nullptr);
    const auto channels = channels_of(file);
    EXPECT_EQ(channels.size(), 5U);
    EXPECT_EQ(channels.at("N.Y")[1], image_of(4, 4, {"Z", "N.X", "N.Y", "N.Z", "id"}).pixels[7]);
}

TEST_F(WriteImage, HalfIsFiniteAndFloatKeepsEverything) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const OutputImage image = one_pixel({"R", "G", "B", "A"}, {1e6f, -infinity, nan, 65519.9f});
    write("half.exr", image);
    Imf::InputFile half_file((folder_ / "half.exr").c_str());
    auto values = channels_of(half_file);
    EXPECT_EQ(values["R"][0], 65504);
    EXPECT_EQ(values["G"][0], -65504);
    EXPECT_EQ(values["B"][0], 0);
    EXPECT_EQ(values["A"][0], 65504);
    write("float.exr", image, full_metadata(), ExrDepth::float32);
    Imf::InputFile float_file((folder_ / "float.exr").c_str());
    values = channels_of(float_file);
    EXPECT_EQ(values["R"][0], 1e6f);
    EXPECT_EQ(values["G"][0], -infinity);
    EXPECT_TRUE(std::isnan(values["B"][0]));
}

TEST_F(WriteImage, AnyNumberOfThreadsWritesTheSameBytes) {
    const OutputImage image = image_of(1024, 700, {"R", "G", "B", "A"});
    const DisplayTransform display = display_of("ACES 1.0 SDR");
    for (const char* name : {"out.exr", "out.png", "out.jpg", "out.tif", "out.webp"}) {
        std::vector<ByteVector> files;
        for (const int threads : {1, 2, 7}) {
            const ThreadLimit limit(threads);
            write(name, image, full_metadata(), ExrDepth::half, {&display});
            files.push_back(read_bytes(folder_ / name));
        }
        EXPECT_TRUE(files[0] == files[1]) << name;
        EXPECT_TRUE(files[0] == files[2]) << name;
    }
}

TEST_F(WriteImage, PngHasStraightAlphaAndDisplayColour) {
    const OutputImage image{
        3, 1, {"R", "G", "B", "A"}, {0.25f, 0.1f, 0.05f, 0.5f, 1, 0.5f, 0, 1, 0.3f, 0.3f, 0.3f, 0}};
    const DisplayTransform display = display_of("Un-tone-mapped");
    DisplayEncoding encoding{&display};
    encoding.dither = false;
    write("out.png", image, full_metadata(), ExrDepth::half, encoding);
    const auto code = [](double linear) {
        return static_cast<uint32_t>(
            std::lround(255 * (linear <= 0.0031308 ? 12.92 * linear
                                                   : 1.055 * std::pow(linear, 1 / 2.4) - 0.055)));
    };
    const std::vector<uint32_t> found = texels("out.png");
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0], code(0.5) | code(0.2) << 8 | code(0.1) << 16 | 128U << 24);
    EXPECT_EQ(found[1], 255U | code(0.5) << 8 | 255U << 24);
    EXPECT_EQ(found[2], 0U);
}

TEST_F(WriteImage, JpegLiesOverBlack) {
    OutputImage image{16, 16, {"R", "G", "B", "A"}, {}};
    for (int i = 0; i < 256; ++i) {
        image.pixels.insert(image.pixels.end(), {0.25f, 0.5f, 0, 0.5f});
    }
    const DisplayTransform display = display_of("Raw");
    for (const char* name : {"out.jpg", "out.JPEG"}) {
        write(name, image, full_metadata(), ExrDepth::half, {&display});
        for (const uint32_t texel : texels(name)) {
            EXPECT_NEAR(texel & 0xFF, 64, 2);
            EXPECT_NEAR(texel >> 8 & 0xFF, 128, 2);
            EXPECT_NEAR(texel >> 16 & 0xFF, 0, 2);
        }
    }
}

TEST_F(WriteImage, CodesAreRoundedAndClamped) {
    OutputImage image{256, 1, {"R", "G", "B"}, {}};
    for (int i = 0; i < 256; ++i) {
        const float code = static_cast<float>(i);
        image.pixels.insert(image.pixels.end(),
                            {code / 255, (code + 0.49f) / 255, (code - 0.49f) / 255});
    }
    image.pixels[0] = -5;
    image.pixels[1] = std::numeric_limits<float>::quiet_NaN();
    image.pixels[3 * 255] = 7;
    write("out.png", image);
    const std::vector<uint32_t> found = texels("out.png");
    for (uint32_t i = 0; i < 256; ++i)
        ASSERT_EQ(found[i], i | i << 8 | i << 16 | 0xFF000000U);
}

TEST_F(WriteImage, DataInAPngIgnoreTheDisplay) {
    ImageMetadata metadata;
    metadata.is_color = false;
    const DisplayTransform display = display_of("ACES 1.0 SDR");
    write("z.png", one_pixel({"Z"}, {0.5f}), metadata, ExrDepth::half, {&display});
    EXPECT_EQ(texels("z.png"), std::vector{0xFF808080U});
    write("n.png",
          one_pixel({"N.X", "N.Y", "N.Z"}, {0.2f, 0.4f, 1}),
          metadata,
          ExrDepth::half,
          {&display});
    EXPECT_EQ(texels("n.png"), std::vector{0xFFFF6633U});
}

TEST_F(WriteImage, OtherExtensionsAndChannelCountsAre64) {
    const OutputImage image = image_of(2, 2, {"R", "G", "B"});
    for (const char* name : {"out.tga", "out", "out.", ".exr", "exr", "out.exr.bak"}) {
        for (const Error& error :
             {error_of(folder_ / name, image), check_output(folder_ / name).error()}) {
            EXPECT_EQ(error.code, ExitCode::usage) << name;
            EXPECT_EQ(error.id, "E-OUT-FORMAT");
            EXPECT_NE(error.message.find(".exr, .png, .jpg, .jpeg, .tif, .tiff, .webp and .avif"),
                      std::string::npos);
        }
    }
    EXPECT_EQ(error_of(folder_ / "two.png", image_of(2, 2, {"u", "v"})).id, "E-OUT-FORMAT");
    EXPECT_EQ(error_of(folder_ / "five.jpg", image_of(2, 2, {"a", "b", "c", "d", "e"})).id,
              "E-OUT-FORMAT");
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(WriteImage, ImpossibleTargetsAre73FromBothSides) {
    std::filesystem::create_directory(folder_ / "folder.exr");
    const OutputImage image = image_of(2, 2, {"R", "G", "B"});
    for (const std::filesystem::path& file : {folder_ / "absent" / "out.exr",
                                              folder_ / "folder.exr",
                                              folder_ / (std::string(300, 'n') + ".png"),
                                              std::filesystem::path("/proc/out.jpg")}) {
        for (const Error& error : {error_of(file, image), check_output(file).error()}) {
            EXPECT_EQ(error.code, ExitCode::cannot_create) << file;
            EXPECT_EQ(error.id, "E-OUT-CREATE");
            EXPECT_EQ(error.where, file.string());
        }
    }
}

TEST_F(WriteImage, CheckOutputAcceptsWhatCanBeWrittenAndLeavesNothing) {
    for (const char* name :
         {"out.exr", "OUT.EXR", "a b.png", "x.jpg", "x.jpeg", "x.TIF", "x.tiff", "x.webp"}) {
        EXPECT_TRUE(check_output(folder_ / name)) << name;
    }
    EXPECT_EQ(check_output(folder_ / "x.TIF")->format, OutputFormat::tiff);
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(WriteImage, AContradictoryImageIs70) {
    OutputImage short_of_pixels = image_of(4, 4, {"R", "G", "B"});
    short_of_pixels.pixels.pop_back();
    for (const OutputImage& image :
         {short_of_pixels, OutputImage{}, OutputImage{-1, -1, {"R"}, {1.0f}}}) {
        const Error error = error_of(folder_ / "out.exr", image);
        EXPECT_EQ(error.code, ExitCode::internal);
        EXPECT_EQ(error.id, "E-OUT-ENCODE");
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(WriteImage, AFullDiskIs74AndTheOldImageSurvives) {
    const DisplayTransform display = display_of("Raw");
    OutputImage large = image_of(400, 400, {"R", "G", "B", "A"});
    for (size_t i = 0; i < large.pixels.size(); ++i) {  // must not compress well
        large.pixels[i] = static_cast<float>(i * 2654435761U % 65521U) / 65521;
    }
    for (const char* name : {"out.exr", "out.png", "out.jpg"}) {
        write(name, image_of(2, 2, {"R", "G", "B"}));
        const ByteVector before = read_bytes(folder_ / name);
        rlimit limits = {};
        getrlimit(RLIMIT_FSIZE, &limits);
        const rlimit low{8192, limits.rlim_max};
        setrlimit(RLIMIT_FSIZE, &low);
        const auto written =
            write_image_file(folder_ / name, large, full_metadata(), {}, {&display});
        setrlimit(RLIMIT_FSIZE, &limits);
        ASSERT_FALSE(written) << name;
        EXPECT_EQ(written.error().code, ExitCode::io_error);
        EXPECT_EQ(written.error().id, "E-OUT-WRITE");
        EXPECT_EQ(read_bytes(folder_ / name), before) << name;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_),
                            std::filesystem::directory_iterator()),
              3);
}

}  // namespace
}  // namespace obscura
