// tests/serve/viewer_test.cpp - wishes become pictures, the last of which is that of a rendering.
// SPDX-License-Identifier: Apache-2.0
#include "serve/viewer.h"

#include <gtest/gtest.h>

#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <algorithm>
#include <ctime>
#include <gmock/gmock.h>
#include <numeric>

namespace obscura::serve {
namespace {

using std::chrono::milliseconds;
using Images = std::vector<std::shared_ptr<const ShownImage>>;

/// Two boxes side by side, of which the right one has another material.
SmallScene two_boxes() {
    SmallScene scene = box_scene();
    scene.nodes = R"({"mesh": 0, "name": "left", "translation": [-2, 0, 0]},
{"mesh": 0, "name": "right", "translation": [2, 0, 0]})";
    scene.roots = "0, 1";
    scene.more.clear();
    return scene;
}

class ViewerTest : public testing::Test {
protected:
    void SetUp() override {
        scene_ = folder_.write("boxes.gltf", gltf_text(two_boxes()));
        viewer_.emplace(scene_, gltf::LoadOptions());
        const Result<LookAt> look = viewer_->open(wish(0, 64, 36, 1));
        ASSERT_TRUE(look) << look.error().message;
        look_ = *look;
    }

    /// A view from the front.
    Wish wish(int number, int width, int height, int samples) const {
        Wish out;
        out.number = number;
        RenderRequest& request = out.request;
        request.scene = scene_;
        request.outputs = {"boxes.png"};
        request.options.width = width;
        request.options.height = height;
        request.options.samples_per_pixel = samples;
        request.camera.eye_m = Vec3d{0, 0, 10};
        request.camera.target_m = Vec3d{0, 0, 0};
        out.rendering = std::to_string(width) + " " + std::to_string(samples);
        return out;
    }

    /// All pictures of a wish up to the finished one, or its error.
    Images pictures_of(int number) {
        Images out;
        constexpr int most = 600;
        for (int i = 0; i < most; ++i) {
            const auto picture = viewer_->wait_for(after_, milliseconds(100));
            if (!picture) continue;
            after_ = picture->serial;
            if (picture->wish != number) continue;
            out.push_back(picture);
            if (picture->is_done || picture->error) return out;
        }
        ADD_FAILURE() << "wish " << number << " is never finished";
        return out;
    }

    /// The next picture of a wish that has so many samples at least.
    std::shared_ptr<const ShownImage> image_of(int number, int samples) {
        constexpr int most = 600;
        for (int i = 0; i < most; ++i) {
            const auto picture = viewer_->wait_for(after_, milliseconds(100));
            if (!picture) continue;
            after_ = picture->serial;
            if (picture->wish == number && picture->samples >= samples) return picture;
        }
        ADD_FAILURE() << "wish " << number << " never has " << samples << " samples";
        return std::make_shared<const ShownImage>();
    }

    std::shared_ptr<const ShownImage> finished(const Wish& wish) {
        viewer_->want(wish);
        const Images all = pictures_of(wish.number);
        return all.empty() ? std::make_shared<const ShownImage>() : all.back();
    }

    /// What a rendering without a viewer shows.
    static std::vector<uint8_t> direct_codes(const Wish& wish) {
        Log log;
        OpenAsset asset(wish.request.scene, {});
        const Result<ChosenCamera> camera = asset.prepare(wish.request, {}, log);
        if (!camera) return {};
        const auto image = asset.renderer().render(wish.request, *camera, {}, log);
        const auto display = make_display(wish.request, log);
        if (!image || !display) return {};
        return displayed_image(wish.request, *image, *display).codes;
    }

    TempFolder folder_;
    std::filesystem::path scene_;
    std::optional<Viewer> viewer_;
    LookAt look_;
    int after_ = 0;
};

TEST_F(ViewerTest, TheCameraIsThatOfTheAsset) {
    EXPECT_NEAR(look_.eye_m.z, 10, 1e-9);
    EXPECT_NEAR(look_.target_m.z, 0, 1e-6);
    EXPECT_NEAR(look_.yfov_rad, 35 * pi_d / 180, 1e-6);
    EXPECT_FALSE(viewer_->scene().bounds.empty());
}

TEST_F(ViewerTest, TheLastImageIsThatOfARendering) {
    const Wish wanted = wish(1, 96, 54, 24);
    const auto picture = finished(wanted);
    EXPECT_EQ(picture->samples, 24);
    EXPECT_EQ(picture->image.width, 96);
    EXPECT_EQ(picture->image.codes.size(), size_t{96} * 54 * 4);
    EXPECT_EQ(picture->image.codes, direct_codes(wanted));
}

TEST_F(ViewerTest, ImagesComeSmallAtFirstAndGetBetter) {
    viewer_->want(wish(1, 1600, 900, 8));
    const Images all = pictures_of(1);
    ASSERT_GE(all.size(), 2U);
    EXPECT_LT(all.front()->image.width, 1600);
    EXPECT_NEAR(all.front()->image.width / (16 / 9.0), all.front()->image.height, 2);
    EXPECT_EQ(all.back()->image.width, 1600);
    for (size_t i = 1; i < all.size(); ++i) {
        EXPECT_GT(all[i]->serial, all[i - 1]->serial);
        EXPECT_GE(all[i]->samples, all[i - 1]->samples);
    }
}

TEST_F(ViewerTest, ANewWishEndsTheOneBefore) {
    viewer_->want(wish(1, 640, 360, 1 << 20));
    ASSERT_TRUE(viewer_->wait_for(0, std::chrono::seconds(30)));
    EXPECT_EQ(finished(wish(2, 32, 18, 2))->image.width, 32);
}

TEST_F(ViewerTest, OtherColoursOfTheSameSamplesNeedNoRendering) {
    const Wish first = wish(1, 64, 36, 4);
    const auto plain = finished(first);
    Wish second = first;
    second.number = 2;
    second.request.display.exposure_ev = -1;
    second.request.options.samples_per_pixel = 1 << 20;  // it would never end
    viewer_->want(second);
    const Images all = pictures_of(2);
    ASSERT_EQ(all.size(), 1U);
    second.request.options.samples_per_pixel = 4;
    EXPECT_EQ(all.front()->image.codes, direct_codes(second));
    EXPECT_NE(all.front()->image.codes, plain->image.codes);
}

TEST_F(ViewerTest, ColoursChangeWhileItRenders) {
    Wish wanted = wish(1, 320, 180, 1 << 20);
    viewer_->want(wanted);
    const int before = image_of(1, 16)->samples;
    wanted.number = 2;
    wanted.request.display.exposure_ev = 1;
    viewer_->want(wanted);
    EXPECT_GE(image_of(2, 0)->samples, before);
}

TEST_F(ViewerTest, OtherSamplesBeginAnew) {
    EXPECT_EQ(finished(wish(1, 32, 18, 64))->samples, 64);
    // However few samples its first picture has, it is shown: this one would take minutes.
    viewer_->want(wish(2, 3200, 1800, 1 << 20));
    EXPECT_LT(image_of(2, 0)->samples, 64);
    EXPECT_EQ(finished(wish(3, 48, 27, 2))->image.width, 48);
    EXPECT_EQ(finished(wish(4, 40, 20, 2))->image.width, 40);
}

TEST_F(ViewerTest, LightIsMadeAnewWhereItDependsOnTheWish) {
    int number = 0;
    const auto expect_as_direct = [&](const char* what, const auto& change) {
        Wish wanted = wish(++number, 48, 27, 4);
        wanted.rendering += std::to_string(number);
        wanted.request.environment = "sky:20,40";
        change(wanted.request);
        EXPECT_EQ(finished(wanted)->image.codes, direct_codes(wanted)) << what;
    };
    const auto catches = [](RenderRequest& request) {
        request.catcher_ground = true;
        request.options.catcher_ground_m = -1.0f;
    };
    expect_as_direct("plain", [](RenderRequest& /*request*/) {});
    expect_as_direct("a catcher", catches);
    expect_as_direct("plain again", [](RenderRequest& /*request*/) {});
    for (const double x : {3.0, -5.0}) {
        expect_as_direct("light that follows the camera", [&](RenderRequest& request) {
            request.camera.eye_m = Vec3d{x, 0, 10};
            request.environment_follows_camera = true;
        });
    }
    expect_as_direct("light that does not", [](RenderRequest& /*request*/) {});
}

TEST_F(ViewerTest, AnOlderWishThatComesLateChangesNothing) {
    viewer_->want(wish(2, 48, 27, 2));
    viewer_->want(wish(1, 32, 18, 2));
    EXPECT_EQ(pictures_of(2).back()->image.width, 48);
    EXPECT_EQ(finished(wish(3, 40, 20, 2))->image.width, 40);
}

TEST_F(ViewerTest, WhatCannotBeRenderedIsToldAndTheNextWishIsGranted) {
    Wish wrong = wish(1, 32, 18, 1);
    wrong.request.camera.up = Vec3d{0, 0, 1};
    const auto failure = finished(wrong);
    ASSERT_TRUE(failure->error);
    EXPECT_EQ(failure->error->id, "E-CAM-VIEW");
    EXPECT_EQ(finished(wish(2, 33, 18, 1))->image.width, 33);
}

TEST_F(ViewerTest, AovsAreShownAsTheirPreviews) {
    Wish normals = wish(1, 64, 36, 8);
    normals.request.options.integrator = Integrator::normal;
    const auto picture = finished(normals);
    EXPECT_EQ(picture->image.channels, 3);
    EXPECT_EQ(picture->image.codes, direct_codes(normals));
}

TEST_F(ViewerTest, PointersPickNodes) {
    EXPECT_EQ(viewer_->pick(0.5, 0.5).error().id, "E-VIEW-EMPTY");
    finished(wish(1, 160, 90, 2));
    // The boxes' fronts are at z = 1: nine metres from the eye along the axis.
    const double tan_half = std::tan(look_.yfov_rad / 2);
    const double x = 0.5 + 0.5 * 2 / (9 * tan_half * 16 / 9);
    const Result<Pick> right = viewer_->pick(x, 0.5);
    ASSERT_TRUE(right) << right.error().message;
    EXPECT_EQ(right->node, "/right");
    EXPECT_FALSE(right->material.empty());
    EXPECT_NEAR(right->point_m.x, 2, 0.1);
    EXPECT_NEAR(right->point_m.z, 1, 1e-3);
    EXPECT_NEAR(right->distance_m, std::hypot(2, 9), 0.1);
    EXPECT_EQ(viewer_->pick(1 - x, 0.5)->node, "/left");
    EXPECT_EQ(viewer_->pick(0.01, 0.01)->node, "");
}

TEST_F(ViewerTest, PicksAreAnsweredAtOnceAndTheRenderingGoesOn) {
    viewer_->want(wish(1, 320, 180, 1 << 20));
    const int before = image_of(1, 16)->samples;
    ASSERT_TRUE(viewer_->pick(0.5, 0.5));  // the rendering itself would take minutes
    // It begins anew, and nothing is shown before it is as far as it was.
    EXPECT_GE(image_of(1, 0)->samples, before);
    EXPECT_GT(image_of(1, before + 1)->samples, before);
}

TEST_F(ViewerTest, MattesAreTheCoverageOfNodes) {
    finished(wish(1, 160, 90, 16));
    const Result<DisplayedImage> left = viewer_->matte("/left");
    const Result<DisplayedImage> right = viewer_->matte("/right");
    ASSERT_TRUE(left && right) << left.error().message;
    EXPECT_EQ(left->channels, 1);
    ASSERT_EQ(left->codes.size(), size_t{160} * 90);
    const auto covered = [](const std::vector<uint8_t>& codes) {
        return std::accumulate(codes.begin(), codes.end(), 0.0) / 255;
    };
    // A cube of 2 m, seen from 10 m: its front alone has this many pixels.
    const double pixels_per_m = 90 / (2 * 9 * std::tan(look_.yfov_rad / 2));
    EXPECT_GT(covered(left->codes), 0.95 * 4 * pixels_per_m * pixels_per_m);
    EXPECT_NEAR(covered(left->codes), covered(right->codes), 0.02 * covered(left->codes));
    EXPECT_EQ(left->codes[45 * 160 + 158], 0);
    const auto in_the_right_box =
        static_cast<size_t>(45 * 160 + 80 + std::lround(2 * pixels_per_m));
    EXPECT_EQ(right->codes[in_the_right_box], 255);
    EXPECT_EQ(left->codes[in_the_right_box], 0);
    EXPECT_EQ(viewer_->matte("/none").error().id, "E-NODE-UNKNOWN");
}

TEST_F(ViewerTest, ImagesAreSavedAsFiles) {
    EXPECT_EQ(viewer_->file({OutputFormat::png, "a.png"}).error().id, "E-VIEW-EMPTY");
    finished(wish(1, 32, 18, 2));
    const auto begins = [&](OutputFormat format, const std::string& name, const char* magic) {
        const Result<EncodedFile> file = viewer_->file({format, name});
        ASSERT_TRUE(file) << file.error().message;
        const std::string bytes(reinterpret_cast<const char*>(file->bytes.data()), 4);
        EXPECT_EQ(bytes, magic) << name;
    };
    begins(OutputFormat::png, "a.png", "\x89PNG");
    begins(OutputFormat::exr, "a.exr", "v/1\x01");
    begins(OutputFormat::webp, "a.webp", "RIFF");
}

TEST_F(ViewerTest, NothingIsRenderedWhileNobodyLooks) {
    viewer_->want(wish(1, 320, 180, 1 << 20));
    ASSERT_TRUE(viewer_->wait_for(0, std::chrono::seconds(30)));
    std::this_thread::sleep_for(milliseconds(3600));
    const std::clock_t before = std::clock();
    std::this_thread::sleep_for(milliseconds(500));
    const double busy_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    EXPECT_LT(busy_s, 0.1);
    // It goes on for the next one who asks.
    const int last = viewer_->wait_for(0, milliseconds(0))->samples;
    for (int i = 0; i < 600; ++i) {
        const auto picture = viewer_->wait_for(after_, milliseconds(100));
        if (!picture) continue;
        after_ = picture->serial;
        if (picture->samples > last) return;
    }
    FAIL() << "it does not go on";
}

}  // namespace
}  // namespace obscura::serve
