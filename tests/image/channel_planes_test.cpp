// tests/image/channel_planes_test.cpp - layers of many channels in memory and in EXR files.
// SPDX-License-Identifier: Apache-2.0
#include "image/channel_planes.h"

#include "image/exr_reading.h"
#include "image/test_images.h"
#include "image/write.h"

#include <numeric>

namespace obscura {
namespace {

using namespace testing_images;

constexpr size_t channels = 10;
constexpr int width = 21;
constexpr int height = 35;
constexpr size_t pixels = size_t{width} * height;

/// The channels of a pixel side by side.
UnsetArray<float> numbered_values() {
    UnsetArray<float> out(channels * pixels);
    std::iota(out.begin(), out.end(), 1.0f);
    return out;
}

TEST(ChannelPlanes, HoldFourChannelsEach) {
    const UnsetArray<float> values = numbered_values();
    UnsetArray<float> planes(values.size());
    separate_planes(values, channels, planes.data());
    EXPECT_EQ(planes[1], values[1]);
    EXPECT_EQ(planes[4], values[channels]) << "the second pixel";
    EXPECT_EQ(planes[4 * pixels + 4], values[channels + 4]) << "its channel 4, in the next plane";
    EXPECT_EQ(planes[8 * pixels + 2], values[channels + 8]) << "the last plane has two";
    UnsetArray<float> back(values.size());
    interleave_planes(planes, channels, back.data());
    EXPECT_EQ(back, values);
}

class PlanesInFiles : public FolderTest {};

TEST_F(PlanesInFiles, AreChannelsLikeAnyOthers) {
    OutputImage image{width, height, {"Y"}, UnsetArray<float>(pixels, 0.5f)};
    ImageLayer& wide = image.layers.emplace_back(ImageLayer{"wide", {}, LayerKind::id, {}});
    for (size_t c = 0; c < channels; ++c)
        wide.channels.push_back("wide." + std::to_string(c));
    const UnsetArray<float> values = numbered_values();
    wide.pixels.resize(values.size());
    separate_planes(values, channels, wide.pixels.data());
    for (const ExrCompression codec : {ExrCompression::zip, ExrCompression::piz}) {
        for (const int tile_size : {0, 16}) {
            for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart}) {
                const std::filesystem::path file = folder_ / "out.exr";
                const ExrOptions options{
                    .layout = layout, .compression = codec, .tile_size = tile_size};
                ASSERT_TRUE(write_image_file(file, image, {}, options, {}));
                Imf::MultiPartInputFile read(file.c_str());
                const int part = layout == ExrLayout::multipart ? 1 : 0;
                expect_exact(channels_of(read, part), wide.channels, values);
            }
        }
    }
}

}  // namespace
}  // namespace obscura
