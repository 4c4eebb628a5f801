// tests/image/memory_test.cpp - images too large for memory are errors, not crashes.
// SPDX-License-Identifier: Apache-2.0
#include "image/decode.h"
#include "image/test_images.h"
#include "image/write.h"

#include <gtest/gtest.h>

#include "support/memory_limit.h"
#include "support/random.h"

namespace obscura {
namespace {

using namespace testing_images;
using test::MemoryLimit;

class ImageMemory : public FolderTest {};

/// Values that do not compress.
OutputImage noisy_image(int side) {
    const size_t count = static_cast<size_t>(side) * static_cast<size_t>(side);
    OutputImage image{side, side, {"R", "G", "B"}, {}};
    Pcg32 random(1);
    for (size_t i = 0; i < 3 * count; ++i)
        image.pixels.push_back(random.next_float());
    return image;
}

TEST_F(ImageMemory, ReadingAndWritingFailWithAnId) {
    const std::filesystem::path file = folder_ / "noise.exr";
    OutputImage image = noisy_image(256);
    {
        const MemoryLimit limit(100000);
        const auto written = write_image_file(file, image, {}, {.depth = ExrDepth::float32}, {});
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().id, "E-OUT-MEMORY");
        EXPECT_EQ(written.error().code, ExitCode::out_of_memory);
    }
    EXPECT_FALSE(std::filesystem::exists(file));
    image.height = 128;
    image.pixels.resize(size_t{3} * 256 * 128);
    ASSERT_TRUE(write_image_file(file, image, {}, {.depth = ExrDepth::float32}, {}));
    Log log(Verbosity::quiet);
    {
        const MemoryLimit limit(300000);
        const auto read = read_environment(file, log);
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().id, "E-ENV-MEMORY");
        EXPECT_EQ(read.error().code, ExitCode::out_of_memory);
    }
    EXPECT_TRUE(read_environment(file, log));
}

TEST_F(ImageMemory, DecodingFailsWithAnId) {
    const ByteVector bytes = png_pattern(256, 256, 3);
    Log log(Verbosity::quiet);
    {
        const MemoryLimit limit(200000);
        const Result<ImageRgba8> image = decode_image(bytes, "scene.gltf#/images/3", log);
        ASSERT_FALSE(image);
        EXPECT_EQ(image.error().id, "E-IMG-MEMORY");
        EXPECT_EQ(image.error().code, ExitCode::out_of_memory);
    }
    EXPECT_TRUE(decode_image(bytes, "scene.gltf#/images/3", log));
}

}  // namespace
}  // namespace obscura
