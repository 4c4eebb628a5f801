// tests/session/fingerprint_test.cpp - what belongs to an image's fingerprint.
// SPDX-License-Identifier: Apache-2.0
#include "session/fingerprint.h"

#include "session/image_parts.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <set>

namespace obscura {
namespace {

const NamedTexts facts = {{"the file a.gltf", "1"}};

TEST(ImageFingerprint, IsOfAllButNamesAndTheRangeOfFrames) {
    const auto of = [&](const NamedTexts& options) {
        return image_fingerprint(options, facts, {});
    };
    const std::string one = of({{"SCENE", "a.gltf"}, {"--spp", "4"}});
    EXPECT_EQ(one.size(), 16U);
    EXPECT_EQ(of({{"SCENE", "b/a.gltf"}, {"--output", "x.png"}, {"--spp", "4"}}), one);
    EXPECT_EQ(of({{"SCENE", "a.gltf"}, {"--spp", "4"}, {"--frames", "1-3"}}), one);
    EXPECT_NE(of({{"SCENE", "a.gltf"}, {"--spp", "5"}}), one);
    EXPECT_NE(of({{"SCENE", "a.gltf"}, {"--spp4", ""}}), one);
    EXPECT_NE(of({{"--spp", "4"}, {"--float", ""}}), one);
    EXPECT_NE(image_fingerprint({{"--spp", "4"}}, {}, {}), one);
    EXPECT_NE(image_fingerprint({}, {{"the file a.gltf", "1"}, {"--spp", "4"}}, {}), one);
}

TEST(ImageFingerprint, OfAFrameIsThatOfItsNumberAndOfTheFirstOne) {
    RenderRequest request;
    const auto of_frame = [&](std::vector<int> numbers, size_t index) {
        request.frames = FrameList{std::move(numbers), 24};
        return image_fingerprint({}, facts, list_images(request, {})->images.at(index).facts);
    };
    const std::string two = of_frame({1, 2, 3}, 1);
    EXPECT_NE(of_frame({1, 2, 3}, 2), two);
    EXPECT_EQ(of_frame({1, 2, 3, 4}, 1), two);
    EXPECT_NE(of_frame({2, 3}, 0), two) << "its view is another";
}

TEST(ImageFingerprint, OfAListIsThatOfTheViewAndTheVariant) {
    RenderRequest request;
    std::vector<View> views = {{.name = "a", .camera = {}, .text = "{\"azimuth\":1}"},
                               {.name = "b", .camera = {}, .text = "{\"azimuth\":2}"}};
    request.lists.views = std::make_shared<const std::vector<View>>(views);
    const auto prints = [&] {
        std::vector<std::string> out;
        const AssetOffer offer{.variants = {"red", "blue"}, .cameras = {}};
        const Result<ImageList> list = list_images(request, offer);
        for (const ListedImage& image : list->images)
            out.push_back(image_fingerprint({{"--variants", "all"}}, facts, image.facts));
        return out;
    };
    const std::vector<std::string> two = prints();
    ASSERT_EQ(two.size(), 2U);
    EXPECT_NE(two[0], two[1]);
    views[0].name = "another";
    request.lists.views = std::make_shared<const std::vector<View>>(views);
    EXPECT_EQ(prints(), two) << "a name changes no pixel";
    request.lists.variants = "all";
    const std::vector<std::string> four = prints();
    ASSERT_EQ(four.size(), 4U);
    EXPECT_EQ(std::set(four.begin(), four.end()).size(), 4U);
}

TEST(ExistingImages, NeedEveryFile) {
    const TempFolder folder;
    const RenderRequest request;
    const ListedImage frame{.outputs = {folder / "a.exr", folder / "a.png"}};
    EXPECT_EQ(lock_file(frame), folder / "a.exr.lock");
    const ExistingImage none = find_existing(request, frame, "1");
    EXPECT_FALSE(none.is_finished);
    EXPECT_EQ(none.differs, "");
    folder.write("a.png", "nonsense");
    EXPECT_EQ(find_existing(request, frame, "1").differs,
              (folder / "a.exr").string() + " is missing");
    folder.write("a.exr", "nonsense");
    const ExistingImage damaged = find_existing(request, frame, "1");
    EXPECT_FALSE(damaged.is_finished);
    EXPECT_EQ(damaged.differs, (folder / "a.exr").string() + " cannot be read");
}

TEST(FileChecksums, AreOfWhatWasReadOnce) {
    const TempFolder folder;
    const auto file = folder.write("sky.hdr", "one");
    FileChecksums checksums;
    const auto first = checksums.of(file);
    ASSERT_TRUE(first);
    folder.write("sky.hdr", "two");
    EXPECT_EQ(checksums.of(file), first);
    EXPECT_NE(FileChecksums().of(file), first);
    EXPECT_FALSE(checksums.of(folder / "absent.hdr"));
}

}  // namespace
}  // namespace obscura
