// tests/app/kept_assets_test.cpp - assets that stay open for later renderings, or are read ahead.
// SPDX-License-Identifier: Apache-2.0
#include "app/kept_assets.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::app {
namespace {

using testing::ElementsAre;
using Texts = std::vector<std::string>;

const std::filesystem::path cornell = OBSCURA_SOURCE_DIR "/assets/cornell/cornell.gltf";

RenderRequest request_for(const std::filesystem::path& scene) {
    RenderRequest request;
    request.scene = scene;
    return request;
}

KeptAsset opened(const RenderRequest& request) {
    Log log;
    return {open_asset(request, log).value()};
}

TEST(KeptAssets, AreTakenOnceByTheirUse) {
    KeptAssets assets;
    const RenderRequest request = request_for(cornell);
    EXPECT_FALSE(assets.take(asset_use(request)));
    assets.keep(asset_use(request), opened(request));
    RenderRequest unlit = request;
    unlit.load.lights.off = true;
    RenderRequest timed = request;
    View later;
    later.time_s = 1;
    timed.lists.views = std::make_shared<const std::vector<View>>(1, later);
    EXPECT_FALSE(assets.take(asset_use(unlit)));
    EXPECT_FALSE(assets.take(asset_use(timed)));
    EXPECT_TRUE(assets.take(asset_use(request)));
    EXPECT_FALSE(assets.take(asset_use(request)));
}

TEST(KeptAssets, AreClosedWhenNothingNeedsThem) {
    KeptAssets assets;
    const RenderRequest request = request_for(cornell);
    assets.keep(asset_use(request), opened(request));
    assets.close_unless([&](const std::filesystem::path& scene) { return scene == cornell; });
    EXPECT_TRUE(assets.close_all());
    EXPECT_FALSE(assets.close_all()) << "there is nothing";
    assets.keep(asset_use(request), opened(request));
    assets.close_unless([](const std::filesystem::path&) { return false; });
    EXPECT_FALSE(assets.take(asset_use(request)));
    assets.read_ahead(request, 2);
    assets.close_unless([](const std::filesystem::path&) { return false; });
    EXPECT_FALSE(assets.close_all()) << "nothing is left of what was read ahead";
}

TEST(KeptAssets, WhatIsReadAheadStandsAsItsFirstImageShowsIt) {
    KeptAssets assets;
    RenderRequest request = request_for(cornell);
    request.load.time_s = 0.5;
    assets.read_ahead(request, 2);
    std::optional<KeptAsset> asset = assets.take(asset_use(request));
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->pose, pose_at(request, 0.5, ""));
    EXPECT_TRUE(asset->renderer.has_scene());
    EXPECT_FALSE(asset->facts.empty());
    Log log;
    asset->notes.tell(log);
    EXPECT_EQ(log.warnings().size(), 1U) << "it has no animation";
    assets.read_ahead(request, 2);
    EXPECT_TRUE(assets.close_all());
    EXPECT_FALSE(assets.take(asset_use(request)));
}

TEST(KeptAssets, WhatCannotBeReadAheadIsForgotten) {
    KeptAssets assets;
    const RenderRequest missing = request_for("none.gltf");
    assets.read_ahead(missing, 2);
    EXPECT_FALSE(assets.take(asset_use(missing)));
    RenderRequest unknown = request_for(cornell);
    unknown.lists.variants = "none";
    assets.read_ahead(unknown, 2);
    EXPECT_FALSE(assets.take(asset_use(unknown)));
    EXPECT_FALSE(assets.is_reading());
    assets.read_ahead(request_for(cornell), 2);
    EXPECT_TRUE(assets.take(asset_use(request_for(cornell)))) << "others are read";
}

TEST(KeptAssets, APoseIsOfATimeAShutterAndAVariant) {
    RenderRequest request;
    const AssetPose plain = pose_at(request, 2, "red");
    EXPECT_EQ(plain, pose_at(request, 2, "red"));
    EXPECT_NE(plain, pose_at(request, 2, "blue"));
    EXPECT_NE(plain, pose_at(request, 3, "red"));
    request.shutter = {-0.25, 0.25};
    request.fps = 10;
    const AssetPose open = pose_at(request, 2, "red");
    EXPECT_NE(plain, open);
    ASSERT_TRUE(open.times.shutter);
    EXPECT_DOUBLE_EQ(open.times.shutter->open_s, 1.975);
    EXPECT_DOUBLE_EQ(open.times.shutter->close_s, 2.025);
    request.frames = FrameList{{12, 1}, 24};
    EXPECT_DOUBLE_EQ(first_time_s(request), 0.5);
}

TEST(Notes, AreShownOnceAndWarningsCountAgain) {
    Texts shown;
    const LogSink show = [&](const LogMessage& message) { shown.emplace_back(message.text); };
    Log log(Verbosity::normal, show);
    Notes notes;
    Log noted = noted_log(log, notes);
    noted.warn("file", "is old");
    noted.info("reading");
    EXPECT_THAT(shown, ElementsAre("is old", "reading"));
    Log later(Verbosity::normal, show);
    notes.tell(later);
    EXPECT_THAT(shown, ElementsAre("is old", "reading")) << "they have been told";
    EXPECT_THAT(later.warnings(), ElementsAre("file: is old"));
    notes.forget_telling();
    shown.clear();
    notes.tell(later);
    EXPECT_THAT(shown, ElementsAre("is old", "reading"));
}

TEST(Notes, AreTakenWhereNobodyIsShownAnything) {
    Log quiet(Verbosity::quiet);
    Notes notes;
    Log noted = noted_log(quiet, notes);
    noted.warn("file", "is old");
    Log other;
    notes.tell(other);
    EXPECT_THAT(quiet.warnings(), ElementsAre("file: is old"));
    EXPECT_THAT(other.warnings(), ElementsAre("file: is old"));
    Notes own;
    Log noting = noting_log(Verbosity::normal, own);
    noting.warn("file", "is torn");
    noting.detail("not wanted");
    Log third;
    own.tell(third);
    EXPECT_THAT(third.warnings(), ElementsAre("file: is torn"));
}

}  // namespace
}  // namespace obscura::app
