// tests/serve/scene_cache_test.cpp - scenes that are sent are kept once, and only a few of them.
// SPDX-License-Identifier: Apache-2.0
#include "serve/scene_cache.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <algorithm>
#include <string_view>

namespace obscura::serve {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<SentScene> send(SceneCache& cache, const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    auto got = cache.scene_of("sha256 of " + text, bytes);
    EXPECT_TRUE(got) << got.error().message;
    return got ? *got : nullptr;
}

TEST(SceneCache, TheSameContentIsOneScene) {
    SceneCache cache;
    const auto first = send(cache, "one");
    EXPECT_EQ(read_whole_file(first->file), "one");
    EXPECT_EQ(send(cache, "one"), first);
    EXPECT_NE(send(cache, "two"), first);
    EXPECT_EQ(cache.count(), 2U);
}

TEST(SceneCache, BinaryFilesAreCalledSo) {
    SceneCache cache;
    EXPECT_EQ(send(cache, "glTF\x02")->file.filename(), "scene.glb");
    EXPECT_EQ(send(cache, "{}")->file.filename(), "scene.gltf");
}

TEST(SceneCache, TheOneThatNobodyAskedForLongestMakesRoom) {
    SceneCache cache(2);
    const fs::path one = send(cache, "one")->file;
    const fs::path two = send(cache, "two")->file;
    EXPECT_EQ(send(cache, "one")->file, one);
    const fs::path three = send(cache, "three")->file;
    EXPECT_EQ(cache.count(), 2U);
    EXPECT_TRUE(fs::exists(one));
    EXPECT_FALSE(fs::exists(two.parent_path()));
    EXPECT_TRUE(fs::exists(three));
}

TEST(SceneCache, WhoHoldsASceneKeepsIt) {
    SceneCache cache(1);
    auto held = send(cache, "held");
    const fs::path file = held->file;
    send(cache, "other");
    EXPECT_TRUE(fs::exists(file));
    held.reset();
    EXPECT_FALSE(fs::exists(file));
}

TEST(SceneCache, ForgetsWhatCannotBeShown) {
    SceneCache cache;
    const auto first = send(cache, "one");
    cache.forget(*first);
    EXPECT_EQ(cache.count(), 0U);
    cache.forget(*first);
    EXPECT_NE(send(cache, "one"), first);
}

TEST(SceneCache, ItsFilesGoWithIt) {
    fs::path file;
    {
        SceneCache cache;
        file = send(cache, "one")->file;
    }
    EXPECT_FALSE(fs::exists(file.parent_path()));
}

}  // namespace
}  // namespace obscura::serve
