// tests/image/fingerprint_test.cpp - fingerprints in the headers of every format that holds them.
// SPDX-License-Identifier: Apache-2.0
#include "image/fingerprint.h"

#include "image/test_images.h"
#include "image/write.h"

#include "support/temp_folder.h"

namespace obscura {
namespace {

TEST(Fingerprint, IsReadFromEveryFormatThatHoldsTexts) {
    const TempFolder folder;
    const OutputImage image{2, 2, {"R", "G", "B"}, {0, 0, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1}};
    ImageMetadata marked;
    marked.extra.push_back({std::string(fingerprint_name), "0123456789abcdef"});
    EXPECT_EQ(fingerprint_of(marked), "0123456789abcdef");
    for (const OutputFormatEntry& format : output_formats) {
        if (format.value == OutputFormat::avif) continue;  // not everywhere
        const auto file = folder / (std::string("a") + format.endings[0]);
        ASSERT_TRUE(write_image_file(file, image, marked, {}, {}));
        const std::optional<std::string> found = read_fingerprint(file);
        EXPECT_EQ(found.has_value(), format.has_texts) << file;
        EXPECT_EQ(found.value_or("0123456789abcdef"), "0123456789abcdef") << file;
        ASSERT_TRUE(write_image_file(file, image, {}, {}, {}));
        EXPECT_EQ(read_fingerprint(file).value_or(""), "") << file;
    }
}

TEST(Fingerprint, IsNotReadFromFilesWhoseEndIsCutOff) {
    const TempFolder folder;
    ImageMetadata marked;
    marked.extra.push_back({std::string(fingerprint_name), "0123456789abcdef"});
    OutputImage image{64, 48, {"R", "G", "B"}, {}};
    for (size_t i = 0; i < size_t{64} * 48 * 3; ++i)
        image.pixels.push_back(static_cast<float>(i * 7919 % 1000) / 1000);
    for (const OutputFormatEntry& format : output_formats) {
        if (!format.has_texts) continue;
        const auto file = folder / (std::string("a") + format.endings[0]);
        ASSERT_TRUE(write_image_file(file, image, marked, {}, {}));
        ASSERT_TRUE(read_fingerprint(file)) << file;
        const uintmax_t size = std::filesystem::file_size(file);
        for (const uintmax_t left : {size - 1, size - 100, size / 2, uintmax_t{20}}) {
            std::filesystem::resize_file(file, left);
            EXPECT_FALSE(read_fingerprint(file)) << file << ' ' << left << " of " << size;
        }
    }
}

TEST(Fingerprint, IsNotInFilesThatCannotBeRead) {
    const TempFolder folder;
    for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif", "a.webp"}) {
        EXPECT_FALSE(read_fingerprint(folder / name)) << "there is no file";
        EXPECT_FALSE(read_fingerprint(folder.write(name, "nonsense")));
        EXPECT_FALSE(read_fingerprint(folder.write(name, "")));
    }
}

}  // namespace
}  // namespace obscura
