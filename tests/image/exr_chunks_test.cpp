// tests/image/exr_chunks_test.cpp - scan lines with ZIP, read back by OpenEXR.
// SPDX-License-Identifier: Apache-2.0
#include "base/page_map.h"
#include "image/exr_reading.h"
#include "image/test_images.h"
#include "image/write.h"

#include "support/random.h"
#include "support/text_files.h"
#include <algorithm>
#include <bit>
#include <filesystem>

namespace obscura {
namespace {

using namespace testing_images;

class ExrChunks : public FolderTest {
protected:
    Imf::MultiPartInputFile write(const OutputImage& image, const ExrOptions& options) {
        const auto written = write_image_file(folder_ / "out.exr", image, {}, options, {});
        EXPECT_TRUE(written) << written.error().message;
        return Imf::MultiPartInputFile((folder_ / "out.exr").c_str());
    }
    uint64_t bytes_with(const OutputImage& image, ExrCompression codec) {
        write(image, {.compression = codec});
        return std::filesystem::file_size(folder_ / "out.exr");
    }
};

/// Numbers with hardly a pattern: packing makes single rows of them no smaller.
UnsetArray<float> random_bits(size_t count) {
    Pcg32 random(7);
    UnsetArray<float> values(count);
    for (float& value : values) {
        const uint32_t exponent_below_infinity = ~(1U << 30U);
        value = std::bit_cast<float>(random.next_uint() & exponent_below_infinity);
    }
    return values;
}

TEST_F(ExrChunks, ZipHoldsPixelsOfAnyHeightPackedOrNot) {
    for (const int height : {1, 15, 16, 17, 48}) {
        constexpr int width = 37;
        const auto count = static_cast<size_t>(width * height);
        OutputImage image{width, height, {"Z"}, UnsetArray<float>(count, 2.0f)};
        image.layers.push_back(
            {"even", {"even.X"}, LayerKind::data, UnsetArray<float>(count, 0.5f), "", "mean"});
        image.layers.push_back({"bits", {"bits.X"}, LayerKind::data, random_bits(count), "", ""});
        for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart}) {
            for (const ExrCompression codec : {ExrCompression::zip, ExrCompression::zips}) {
                SCOPED_TRACE(height);
                Imf::MultiPartInputFile file = write(
                    image, {.depth = ExrDepth::float32, .layout = layout, .compression = codec});
                for (int part = 0; part < file.parts(); ++part)
                    EXPECT_TRUE(file.partComplete(part));  // else OpenEXR mends its table
                for (size_t i = 0; i < image.layers.size(); ++i) {
                    const int part = layout == ExrLayout::single ? 0 : static_cast<int>(i) + 1;
                    const ImageLayer& layer = image.layers[i];
                    expect_exact(channels_of(file, part), layer.channels, layer.pixels);
                }
            }
        }
    }
}

TEST_F(ExrChunks, PackedPixelsTakeLessThanTheirBytes) {
    OutputImage image{256, 256, {"R", "G", "B", "A"}, UnsetArray<float>(4UL * 256 * 256)};
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = 1 + 0.001f * static_cast<float>(i / 1024);
    const uint64_t plain = bytes_with(image, ExrCompression::none);
    EXPECT_LT(bytes_with(image, ExrCompression::zip), plain / 10);
    EXPECT_LT(bytes_with(image, ExrCompression::zips), plain / 10);
}

TEST_F(ExrChunks, BytesDoNotDependOnWhereMemoryLies) {
    OutputImage image{31, 1, {"R", "G", "B", "A"}, UnsetArray<float>(4UL * 31)};
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = i % 4 == 3 ? 1.0f : 0.25f + 0.01f * static_cast<float>(i * i % 31);
    std::vector<std::vector<char>> in_the_way;
    std::string first;
    for (int turn = 0; turn < 300; ++turn) {
        write(image, {});
        const std::string bytes = read_text(folder_ / "out.exr");
        if (first.empty()) first = bytes;
        ASSERT_TRUE(bytes == first) << turn;
        in_the_way.emplace_back(100'000);  // where the compressor's state lay
    }
}

/// Zeros with some values here and there, over many pages.
UnsetArray<float> sparse_values(size_t count) {
    UnsetArray<float> values = zero_array<float>(count);
    for (size_t i = 12345; i < count; i = i * 5 / 4)
        std::fill_n(values.begin() + static_cast<ptrdiff_t>(i), 700, static_cast<float>(i));
    return values;
}

TEST_F(ExrChunks, PagesThatNobodyHasWrittenStaySo) {
    constexpr int width = 1000;
    constexpr int height = 410;
    constexpr size_t pixels = 1000 * 410;
    OutputImage image{width, height, {"Z"}, UnsetArray<float>(pixels, 2.0f)};
    const std::vector<std::string> names = {"far.R", "far.G", "far.B"};
    image.layers.push_back(
        {"far", names, LayerKind::data, sparse_values(names.size() * pixels), "", "mean"});
    image.layers.push_back({"none",
                            {"none.R", "none.G", "none.B"},
                            LayerKind::color,
                            zero_array<float>(names.size() * pixels),
                            "",
                            "mean"});
    Imf::MultiPartInputFile file = write(image, {});
    const PageMap map;
    const bool is_told = !map.look_at(zero_array<float>(pixels * 3)).all();
    for (const ImageLayer& layer : image.layers)
        EXPECT_EQ(map.look_at(layer.pixels).all(), !is_told) << layer.name;
    for (const ImageLayer& layer : image.layers)
        expect_exact(channels_of(file, 0), layer.channels, layer.pixels);
}

}  // namespace
}  // namespace obscura
