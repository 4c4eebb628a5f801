// tests/session/fingerprint_test.cpp - what belongs to an image's fingerprint.
// SPDX-License-Identifier: Apache-2.0
#include "session/fingerprint.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace obscura {
namespace {

const NamedTexts facts = {{"the file a.gltf", "1"}};

TEST(ImageFingerprint, IsOfAllButNamesAndTheRangeOfFrames) {
    const RenderRequest request;
    const auto of = [&](const NamedTexts& options) {
        return image_fingerprint(options, facts, request, {});
    };
    const std::string one = of({{"SCENE", "a.gltf"}, {"--spp", "4"}});
    EXPECT_EQ(one.size(), 16U);
    EXPECT_EQ(of({{"SCENE", "b/a.gltf"}, {"--output", "x.png"}, {"--spp", "4"}}), one);
    EXPECT_EQ(of({{"SCENE", "a.gltf"}, {"--spp", "4"}, {"--frames", "1-3"}}), one);
    EXPECT_NE(of({{"SCENE", "a.gltf"}, {"--spp", "5"}}), one);
    EXPECT_NE(of({{"SCENE", "a.gltf"}, {"--spp4", ""}}), one);
    EXPECT_NE(of({{"--spp", "4"}, {"--float", ""}}), one);
    EXPECT_NE(image_fingerprint({{"--spp", "4"}}, {}, request, {}), one);
    EXPECT_NE(image_fingerprint({}, {{"the file a.gltf", "1"}, {"--spp", "4"}}, request, {}), one);
}

TEST(ImageFingerprint, OfAFrameIsThatOfItsNumberAndOfTheFirstOne) {
    RenderRequest request;
    request.frames = FrameList{{1, 2, 3}, 24};
    const std::string two = image_fingerprint({}, facts, request, 2);
    EXPECT_NE(image_fingerprint({}, facts, request, 3), two);
    request.frames = FrameList{{1, 2, 3, 4}, 24};
    EXPECT_EQ(image_fingerprint({}, facts, request, 2), two);
    request.frames = FrameList{{2, 3}, 24};
    EXPECT_NE(image_fingerprint({}, facts, request, 2), two) << "its view is another";
}

TEST(ExistingImages, NeedEveryFile) {
    const TempFolder folder;
    const RenderRequest request;
    const MovieFrame frame{{}, 0, {folder / "a.exr", folder / "a.png"}};
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

}  // namespace
}  // namespace obscura
