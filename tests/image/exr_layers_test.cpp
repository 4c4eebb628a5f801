// tests/image/exr_layers_test.cpp - EXR files of many layers, codecs, tiles and levels, read back.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "image/exr_reading.h"
#include "image/test_images.h"
#include "image/write.h"

#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include "support/random.h"
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace obscura {
namespace {

using namespace testing_images;

constexpr std::array all_codecs = {ExrCompression::none,
                                   ExrCompression::rle,
                                   ExrCompression::zips,
                                   ExrCompression::zip,
                                   ExrCompression::piz,
                                   ExrCompression::pxr24,
                                   ExrCompression::b44,
                                   ExrCompression::b44a,
                                   ExrCompression::dwaa,
                                   ExrCompression::dwab};
constexpr std::array all_layouts = {ExrLayout::single, ExrLayout::multipart, ExrLayout::separate};

/// Values that need all 24 bits of a float's mantissa.
UnsetArray<float> noise(size_t count, uint64_t seed) {
    Pcg32 random(seed);
    UnsetArray<float> values(count);
    for (float& value : values)
        value = 1000 * random.next_float() - 300;
    return values;
}

/// Names that DWA takes for colours, although they are data.
OutputImage layered(int width, int height) {
    const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
    OutputImage image{width, height, {"R", "G", "B", "A"}, noise(4 * count, 1)};
    image.layers.push_back({"albedo",
                            {"albedo.R", "albedo.G", "albedo.B"},
                            LayerKind::color,
                            noise(3 * count, 2),
                            "albedo",
                            "mean"});
    image.layers.push_back({"normal",
                            {"normal.X", "normal.Y", "normal.Z"},
                            LayerKind::data,
                            noise(3 * count, 3),
                            "normal",
                            "mean"});
    image.layers.push_back({"depth", {"Z"}, LayerKind::data, noise(count, 4), "depth", "nearest"});
    image.layers.push_back({"crypto00",
                            {"crypto00.R", "crypto00.G"},
                            LayerKind::id,
                            noise(2 * count, 5),
                            "material",
                            "",
                            {{"cryptomatte/1234567/name", "crypto"}}});
    return image;
}

class ExrLayers : public FolderTest {
protected:
    WriteReport write(const OutputImage& image, const ExrOptions& options) {
        const auto written = write_image_file(folder_ / "out.exr", image, {}, options, {});
        EXPECT_TRUE(written) << written.error().message;
        return written ? *written : WriteReport{};
    }

    Imf::MultiPartInputFile open(const char* name = "out.exr") {
        return Imf::MultiPartInputFile((folder_ / name).c_str());
    }

    Error error_of(const OutputImage& image, const ExrOptions& options = {}) {
        const auto written = write_image_file(folder_ / "out.exr", image, {}, options, {});
        EXPECT_FALSE(written);
        return written ? Error{} : written.error();
    }

    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            names.insert(entry.path().filename().string());
        return names;
    }

    /// Where a layer is in what write() left: the file and the part's index.
    std::pair<std::string, int> place_of(size_t layer, ExrLayout layout) {
        if (layout == ExrLayout::single) return {"out.exr", 0};
        if (layout == ExrLayout::multipart) return {"out.exr", static_cast<int>(layer) + 1};
        return {"out." + layered(1, 1).layers[layer].name + ".exr", 0};
    }
};

TEST_F(ExrLayers, ASinglePartHasAllChannelsAndSaysWhatTheyAre) {
    const OutputImage image = layered(19, 11);
    write(image, {.depth = ExrDepth::float32});
    Imf::MultiPartInputFile file = open();
    ASSERT_EQ(file.parts(), 1);
    const Channels found = channels_of(file);
    EXPECT_EQ(found.size(), 13U);
    expect_exact(found, image.channels, image.pixels);
    for (const ImageLayer& layer : image.layers)
        expect_exact(found, layer.channels, layer.pixels);
    const Imf::Header& header = file.header(0);
    EXPECT_EQ(text_of(header, "obscura:kind"), "color");
    EXPECT_EQ(text_of(header, "obscura:layer:albedo:kind"), "color");
    EXPECT_EQ(text_of(header, "obscura:layer:normal:kind"), "data");
    EXPECT_EQ(text_of(header, "obscura:layer:crypto00:kind"), "id");
    EXPECT_EQ(text_of(header, "obscura:layer:crypto00:expression"), "material");
    EXPECT_EQ(text_of(header, "obscura:layer:depth:reduction"), "nearest");
    EXPECT_EQ(text_of(header, "cryptomatte/1234567/name"), "crypto");
}

TEST_F(ExrLayers, ColoursAreHalvesAndDataAreFloats) {
    for (const ExrDepth depth : {ExrDepth::half, ExrDepth::float32}) {
        write(layered(4, 4), {.depth = depth});
        const Imf::MultiPartInputFile file = open();
        const Imf::ChannelList& channels = file.header(0).channels();
        const Imf::PixelType color = depth == ExrDepth::half ? Imf::HALF : Imf::FLOAT;
        for (const char* name : {"R", "A", "albedo.G"})
            EXPECT_EQ(channels.findChannel(name)->type, color) << name;
        for (const char* name : {"Z", "normal.Y", "crypto00.R"})
            EXPECT_EQ(channels.findChannel(name)->type, Imf::FLOAT) << name;
    }
}

TEST_F(ExrLayers, PartsAreNamedAfterTheLayersAndSpeakForThemselves) {
    const OutputImage image = layered(19, 11);
    write(image, {.depth = ExrDepth::float32, .layout = ExrLayout::multipart});
    Imf::MultiPartInputFile file = open();
    ASSERT_EQ(file.parts(), 5);
    const char* names[] = {"rgba", "albedo", "normal", "depth", "crypto00"};
    const char* kinds[] = {"color", "color", "data", "data", "id"};
    const char* spaces[] = {"lin_rec709_scene", "lin_rec709_scene", "data", "data", "data"};
    for (int part = 0; part < 5; ++part) {
        SCOPED_TRACE(names[part]);
        const Imf::Header& header = file.header(part);
        EXPECT_EQ(header.name(), names[part]);
        EXPECT_EQ(text_of(header, "obscura:kind"), kinds[part]);
        EXPECT_EQ(text_of(header, "colorInteropID"), spaces[part]);
        EXPECT_EQ(Imf::hasChromaticities(header), std::string(kinds[part]) == "color");
        const bool first = part == 0;
        const ImageLayer* layer = first ? nullptr : &image.layers[static_cast<size_t>(part) - 1];
        const Channels found = channels_of(file, part);
        EXPECT_EQ(found.size(), first ? 4U : layer->channels.size());
        expect_exact(
            found, first ? image.channels : layer->channels, first ? image.pixels : layer->pixels);
    }
    EXPECT_EQ(text_of(file.header(3), "obscura:expression"), "depth");
    EXPECT_EQ(text_of(file.header(3), "obscura:reduction"), "nearest");
    EXPECT_EQ(text_of(file.header(4), "cryptomatte/1234567/name"), "crypto");
    EXPECT_EQ(text_of(file.header(0), "cryptomatte/1234567/name"), "crypto");
    EXPECT_EQ(text_of(file.header(3), "cryptomatte/1234567/name"), "(no cryptomatte/1234567/name)");
}

/// The rows from `first` to `end` of interleaved values.
UnsetArray<float> rows_of(const UnsetArray<float>& values, size_t row, size_t first, size_t end) {
    UnsetArray<float> out(row * (end - first));
    std::copy_n(values.data() + first * row, out.size(), out.data());
    return out;
}

TEST_F(ExrLayers, EyesAboveEachOtherBecomeViews) {
    const OutputImage image = layered(19, 12);
    ImageMetadata metadata;
    metadata.standard.views = {"left", "right"};
    for (const int tile_size : {0, 16}) {
        const ExrOptions options{.depth = ExrDepth::float32,
                                 .layout = ExrLayout::multipart,
                                 .tile_size = tile_size,
                                 .mipmap = tile_size > 0};
        ASSERT_TRUE(write_image_file(folder_ / "out.exr", image, metadata, options, {}));
        Imf::MultiPartInputFile file = open();
        ASSERT_EQ(file.parts(), 10);
        for (int part = 0; part < 10; ++part) {
            const bool right = part >= 5;
            EXPECT_EQ(file.header(part).view(), right ? "right" : "left");
            const size_t first = right ? 6 : 0;
            const bool beauty = part % 5 == 0;
            const ImageLayer& layer = image.layers[beauty ? 0 : static_cast<size_t>(part % 5) - 1];
            const std::vector<std::string>& names = beauty ? image.channels : layer.channels;
            const UnsetArray<float>& values = beauty ? image.pixels : layer.pixels;
            EXPECT_EQ(file.header(part).name(),
                      (beauty ? "rgba" : layer.name) + (right ? "-right" : "-left"));
            expect_exact(channels_of(file, part),
                         names,
                         rows_of(values, 19 * names.size(), first, first + 6));
        }
    }
}

TEST_F(ExrLayers, ACropMayShowOneEyeOrTheEdgeOfBoth) {
    OutputImage image{3, 4, {"Y"}, noise(12, 1)};
    ImageMetadata metadata;
    metadata.standard.views = {"left", "right"};
    const ExrOptions options{.depth = ExrDepth::float32, .layout = ExrLayout::multipart};
    image.part_of = ImagePart{8, 20, 2, 7};  // rows 7 to 9 of the left eye, row 0 of the right one
    ASSERT_TRUE(write_image_file(folder_ / "out.exr", image, metadata, options, {}));
    Imf::MultiPartInputFile both = open();
    ASSERT_EQ(both.parts(), 2);
    for (const int part : {0, 1})
        EXPECT_EQ(both.header(part).displayWindow(), Imath::Box2i({0, 0}, {7, 9}));
    EXPECT_EQ(both.header(0).dataWindow(), Imath::Box2i({2, 7}, {4, 9}));
    EXPECT_EQ(both.header(1).dataWindow(), Imath::Box2i({2, 0}, {4, 0}));
    expect_exact(channels_of(both, 0), {"Y"}, rows_of(image.pixels, 3, 0, 3));
    expect_exact(channels_of(both, 1), {"Y"}, rows_of(image.pixels, 3, 3, 4));
    image.part_of->y = 16;
    ASSERT_TRUE(write_image_file(folder_ / "out.exr", image, metadata, options, {}));
    const Imf::MultiPartInputFile right = open();
    ASSERT_EQ(right.parts(), 1);
    EXPECT_EQ(right.header(0).view(), "right");
    EXPECT_EQ(right.header(0).dataWindow(), Imath::Box2i({2, 6}, {4, 9}));
}

TEST_F(ExrLayers, ABeautyOfDataMayHaveColoursBesideIt) {
    OutputImage image = layered(4, 4);
    image.channels = {"u", "v"};
    image.pixels.resize(32);
    ImageMetadata metadata;
    metadata.is_color = false;
    ASSERT_TRUE(write_image_file(
        folder_ / "out.exr", image, metadata, {.layout = ExrLayout::multipart}, {}));
    const Imf::MultiPartInputFile file = open();
    EXPECT_EQ(file.header(0).name(), "main");
    EXPECT_EQ(file.header(0).channels().findChannel("u")->type, Imf::FLOAT);
    EXPECT_EQ(text_of(file.header(0), "colorInteropID"), "data");
    EXPECT_TRUE(Imf::hasChromaticities(file.header(1)));
}

TEST_F(ExrLayers, SeparateFilesLieBesideTheBeauty) {
    const OutputImage image = layered(19, 11);
    write(image, {.depth = ExrDepth::float32, .layout = ExrLayout::separate});
    EXPECT_EQ(
        files(),
        (std::set<std::string>{
            "out.exr", "out.albedo.exr", "out.normal.exr", "out.depth.exr", "out.crypto00.exr"}));
    Imf::MultiPartInputFile beauty = open();
    EXPECT_EQ(channels_of(beauty).size(), 4U);
    for (const ImageLayer& layer : image.layers) {
        Imf::MultiPartInputFile file = open(("out." + layer.name + ".exr").c_str());
        ASSERT_EQ(file.parts(), 1);
        const Channels found = channels_of(file);
        EXPECT_EQ(found.size(), layer.channels.size());
        expect_exact(found, layer.channels, layer.pixels);
        EXPECT_EQ(text_of(file.header(0), "obscura:expression"), layer.expression);
    }
}

TEST(LayerFile, TheNumberOfAFrameStaysLast) {
    EXPECT_EQ(layer_file("a/shot.exr", "Z"), "a/shot.Z.exr");
    EXPECT_EQ(layer_file("a/shot.0012.exr", "Z"), "a/shot.Z.0012.exr");
    EXPECT_EQ(layer_file("shot12.EXR", "diffuse.left"), "shot12.diffuse.left.EXR");
    EXPECT_EQ(layer_file("12.exr", "Z"), "12.Z.exr");
}

TEST_F(ExrLayers, EachFileIsWrittenWholeOrNotAtAll) {
    std::filesystem::create_directory(folder_ / "out.depth.exr");
    const Error error = error_of(layered(4, 4), {.layout = ExrLayout::separate});
    EXPECT_EQ(error.id, "E-OUT-CREATE");
    EXPECT_EQ(error.where, (folder_ / "out.depth.exr").string());
    EXPECT_EQ(files(), (std::set<std::string>{"out.albedo.exr", "out.normal.exr", "out.depth.exr"}))
        << "the beauty comes last";
    Imf::MultiPartInputFile normal = open("out.normal.exr");
    EXPECT_EQ(channels_of(normal).size(), 3U);
}

/// Whatever the codec for colours is, data and ids keep all their bits.
TEST_F(ExrLayers, NoCodecTouchesDataAndIds) {
    const OutputImage image = layered(70, 45);
    for (const ExrLayout layout : all_layouts) {
        for (const ExrDepth depth : {ExrDepth::half, ExrDepth::float32}) {
            for (const ExrCompression codec : all_codecs) {
                SCOPED_TRACE(static_cast<int>(codec) + 100 * static_cast<int>(layout));
                write(image, {.depth = depth, .layout = layout, .compression = codec});
                for (size_t i = 1; i < image.layers.size(); ++i) {
                    const auto [name, part] = place_of(i, layout);
                    Imf::MultiPartInputFile file = open(name.c_str());
                    const ImageLayer& layer = image.layers[i];
                    expect_exact(channels_of(file, part), layer.channels, layer.pixels);
                }
            }
        }
    }
}

/// Largest difference of colours, relative to the largest value.
float loss(const Channels& found, const OutputImage& image) {
    float difference = 0;
    float largest = 0;
    for (size_t c = 0; c < 3; ++c) {
        const std::vector<float>& channel = found.at(image.channels[c]);
        for (size_t i = 0; i < channel.size(); ++i) {
            const float value = image.pixels[4 * i + c];
            difference = std::max(difference, std::abs(channel[i] - value));
            largest = std::max(largest, std::abs(value));
        }
    }
    return difference / largest;
}

TEST_F(ExrLayers, ColoursHaveTheCodecThatIsAskedFor) {
    OutputImage image = layered(70, 45);
    for (float& value : image.pixels)  // from 1 to 2, where halves are 2^-10 apart
        value = 1.3f + value / 1000;
    for (const ExrCompression codec : all_codecs) {
        SCOPED_TRACE(static_cast<int>(codec));
        const bool lossy = codec >= ExrCompression::pxr24;
        const auto wanted = static_cast<Imf::Compression>(codec);
        write(image, {.layout = ExrLayout::multipart, .compression = codec});
        Imf::MultiPartInputFile file = open();
        EXPECT_EQ(file.header(0).compression(), wanted);
        EXPECT_EQ(file.header(1).compression(), wanted);
        for (const int part : {2, 3, 4}) {
            EXPECT_EQ(file.header(part).compression(), lossy ? Imf::ZIP_COMPRESSION : wanted);
        }
        const bool rounds_halves = codec > ExrCompression::pxr24;
        const float lost = loss(channels_of(file), image);
        EXPECT_EQ(lost > 2.5e-4f, rounds_halves) << lost;
        EXPECT_LT(lost, 0.1f);
    }
}

TEST_F(ExrLayers, ASinglePartWithDataSaysThatItsColoursAreLossless) {
    OutputImage image = layered(20, 20);
    for (const ExrCompression codec : all_codecs) {
        SCOPED_TRACE(static_cast<int>(codec));
        const bool rounds = codec == ExrCompression::pxr24 || codec >= ExrCompression::dwaa;
        const WriteReport report = write(image, {.compression = codec});
        EXPECT_EQ(report.lossless_instead, rounds);
        EXPECT_EQ(open().header(0).compression(),
                  rounds ? Imf::ZIP_COMPRESSION : static_cast<Imf::Compression>(codec));
    }
    image.layers.resize(1);
    EXPECT_FALSE(write(image, {.compression = ExrCompression::dwaa}).lossless_instead);
    EXPECT_EQ(open().header(0).compression(), Imf::DWAA_COMPRESSION) << "colours only";
    image = layered(20, 20);
    EXPECT_FALSE(write(image, {.layout = ExrLayout::multipart, .compression = ExrCompression::dwaa})
                     .lossless_instead);
}

TEST_F(ExrLayers, AGreaterDwaLevelMakesSmallerFiles) {
    OutputImage image = layered(128, 128);
    image.layers.clear();
    const auto size_at = [&](float level) {
        write(image, {.compression = ExrCompression::dwab, .dwa_level = level});
        return std::filesystem::file_size(folder_ / "out.exr");
    };
    EXPECT_LT(size_at(2000), size_at(45));
    EXPECT_LT(size_at(45), size_at(1));
}

TEST_F(ExrLayers, APartOfAnImageHasItsDataWindowInEveryPart) {
    OutputImage image = layered(9, 7);
    image.part_of = ImagePart{640, 480, 100, 50};
    for (const int tile_size : {0, 4}) {
        const ExrOptions options{
            .depth = ExrDepth::float32, .layout = ExrLayout::multipart, .tile_size = tile_size};
        write(image, options);
        Imf::MultiPartInputFile file = open();
        for (int part = 0; part < file.parts(); ++part) {
            EXPECT_EQ(file.header(part).displayWindow(), Imath::Box2i({0, 0}, {639, 479}));
            EXPECT_EQ(file.header(part).dataWindow(), Imath::Box2i({100, 50}, {108, 56}));
        }
        expect_exact(channels_of(file, 3), {"Z"}, image.layers[2].pixels);
    }
}

TEST_F(ExrLayers, TilesHoldTheSamePixels) {
    const OutputImage image = layered(37, 29);
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart}) {
        write(image, {.depth = ExrDepth::float32, .layout = layout, .tile_size = 16});
        Imf::MultiPartInputFile file = open();
        const Imf::TileDescription& tiles = file.header(0).tileDescription();
        EXPECT_EQ(tiles, Imf::TileDescription(16, 16, Imf::ONE_LEVEL));
        expect_exact(channels_of(file), image.channels, image.pixels);
        const auto [name, part] = place_of(3, layout);
        expect_exact(channels_of(file, part), image.layers[3].channels, image.layers[3].pixels);
    }
}

TEST_F(ExrLayers, LevelsAreMeansAndOfIdsTheUpperLeftPixel) {
    // 5 x 3 pixels; levels of 5x3, 2x1 and 1x1.
    OutputImage image{5, 3, {"R"}, {}};
    for (int i = 0; i < 15; ++i)
        image.pixels.push_back(static_cast<float>(i));
    image.layers.push_back({"id", {"id"}, LayerKind::id, image.pixels});
    image.layers.push_back({"near", {"near"}, LayerKind::data, image.pixels, "", "nearest"});
    image.layers.push_back({"mean", {"mean"}, LayerKind::data, image.pixels, "", "mean"});
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart}) {
        write(image, {.layout = layout, .mipmap = true});
        Imf::MultiPartInputFile file = open();
        EXPECT_EQ(file.header(0).tileDescription(),
                  Imf::TileDescription(64, 64, Imf::MIPMAP_LEVELS));
        Channels first;
        Channels second;
        for (int part = 0; part < file.parts(); ++part) {
            first.merge(level_of(file, part, 1));
            second.merge(level_of(file, part, 2));
        }
        using Values = std::vector<float>;
        for (const char* name : {"R", "mean"}) {
            EXPECT_EQ(first[name], (Values{3, 5})) << "the means of 0 1 5 6 and 2 3 7 8";
            EXPECT_EQ(second[name], Values{4});
        }
        for (const char* name : {"id", "near"}) {
            EXPECT_EQ(first[name], (Values{0, 2}));
            EXPECT_EQ(second[name], Values{0});
        }
    }
}

TEST_F(ExrLayers, ClampedValuesAreCountedInHalvesOnly) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    OutputImage image{2, 2, {"R"}, {65504, 65505, -infinity, std::nanf("")}};
    image.layers.push_back({"c", {"c.R"}, LayerKind::color, {1e9f, -1e9f, 1, -65504}});
    image.layers.push_back({"d", {"d"}, LayerKind::data, {1e9f, -1e9f, infinity, 1}});
    for (const ExrLayout layout : all_layouts) {
        EXPECT_EQ(write(image, {.layout = layout}).clamped_values, 4U);
        EXPECT_EQ(write(image, {.layout = layout, .mipmap = true}).clamped_values, 4U);
        const ExrOptions floats{.depth = ExrDepth::float32, .layout = layout};
        EXPECT_EQ(write(image, floats).clamped_values, 0U);
    }
}

TEST_F(ExrLayers, DwaWritesHalvesThatStayFinite) {
    constexpr size_t side = 64;
    OutputImage image{side, side, {"R", "G", "B"}, UnsetArray<float>(3 * side * side)};
    Pcg32 random(7);
    for (float& value : image.pixels)  // black and white spread the error farthest
        value = random.next_float() < 0.5f ? 0.0f : 1e6f;
    for (const float level : {0.0f, 45.0f, 300.0f, 1000.0f}) {
        for (const ExrDepth depth : {ExrDepth::half, ExrDepth::float32}) {
            const WriteReport report = write(
                image, {.depth = depth, .compression = ExrCompression::dwaa, .dwa_level = level});
            EXPECT_EQ(report.half_instead, depth == ExrDepth::float32);
            EXPECT_GT(report.clamped_values, side * side);
            Imf::MultiPartInputFile file = open();
            EXPECT_EQ(file.header(0).channels()["R"].type, Imf::HALF);
            float most = 0;
            for (const auto& [name, values] : channels_of(file))
                most = std::max(most, *std::max_element(values.begin(), values.end()));
            EXPECT_LE(most, 65504) << level;
            EXPECT_GT(most, 0.9f * report.largest_half) << level;
        }
    }
}

TEST_F(ExrLayers, AnyNumberOfThreadsWritesTheSameBytes) {
    const OutputImage image = layered(700, 300);
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart}) {
        for (const bool mipmap : {false, true}) {
            std::vector<ByteVector> written;
            for (const int threads : {1, 7, 2}) {
                const ThreadLimit limit(threads);
                write(image, {.layout = layout, .mipmap = mipmap});
                written.push_back(read_bytes(folder_ / "out.exr"));
            }
            EXPECT_TRUE(written[0] == written[1]);
            EXPECT_TRUE(written[0] == written[2]);
        }
    }
}

TEST_F(ExrLayers, LayersThatNoFileCanHoldAre64) {
    const auto refused = [&](const auto& spoil) {
        OutputImage image = layered(2, 2);
        spoil(image.layers);
        const Error error = error_of(image);
        EXPECT_EQ(error.code, ExitCode::usage);
        EXPECT_EQ(error.id, "E-OUT-LAYER");
    };
    using Layers = std::vector<ImageLayer>;
    for (const char* name : {"", "a/b", "a\\b", "a\nb", "normal", "rgba"})
        refused([&](Layers& layers) { layers[0].name = name; });
    for (const char* channel : {"", "R", "Z", "albedo.G"})
        refused([&](Layers& layers) { layers[0].channels[0] = channel; });
    EXPECT_TRUE(files().empty());
}

TEST_F(ExrLayers, LayersOfAnotherSizeAre70) {
    OutputImage image = layered(4, 4);
    image.layers[2].pixels.pop_back();
    EXPECT_EQ(error_of(image).id, "E-OUT-ENCODE");
    image.layers[2].channels.clear();
    image.layers[2].pixels.clear();
    EXPECT_EQ(error_of(image).id, "E-OUT-ENCODE");
    EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace obscura
