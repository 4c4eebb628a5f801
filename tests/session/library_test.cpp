// tests/session/library_test.cpp - the library, used as by a program that embeds it.
// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "support/library_view.h"
#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <algorithm>
#include <atomic>
#include <cstring>
#include <gmock/gmock.h>
#include <new>
#include <obscura/obscura.h>
#include <stdexcept>
#include <thread>

namespace obscura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

const std::string assets = OBSCURA_SOURCE_DIR "/assets/";

Sampling few_samples() {
    Sampling sampling;
    sampling.samples_per_pixel = 3;
    return sampling;
}

/// The image, or a failed test.
Image image_of(const Result<Image>& result) {
    EXPECT_TRUE(result) << result.error().text;
    return result ? *result : Image{};
}

Image fresh_image(const std::string& file, const View& view, const Look& look = {}) {
    Session session;
    const Result<Asset> asset = session.open(file);
    EXPECT_TRUE(asset) << asset.error().text;
    return image_of(session.render(*asset, view, look, few_samples()));
}

TEST(Library, AnAssetTellsWhatItHolds) {
    Session session;
    const Result<Asset> asset = session.open(assets + "cameras/cameras.gltf");
    ASSERT_TRUE(asset) << asset.error().text;
    const AssetInfo& info = asset->info();
    EXPECT_EQ(info.file, "cameras.gltf");
    EXPECT_GT(info.cameras.size(), 1U);
    EXPECT_EQ(info.cameras[0].world_from_camera[15], 1);
    EXPECT_FALSE(info.is_empty);
    EXPECT_LT(info.low[0], info.high[0]);
    EXPECT_GT(info.triangles, 0U);
    const auto path = [](const NodeInfo& node) { return node.path; };
    EXPECT_THAT(asset->nodes(), Contains(testing::ResultOf(path, "/Floor")));
    const Result<Asset> moving = session.open(assets + "motion/motion.glb");
    ASSERT_TRUE(moving);
    ASSERT_FALSE(moving->info().animations.empty());
    EXPECT_GT(moving->info().animations[0].end_s, 0);
}

TEST(Library, ErrorsNameFieldsAndNoOptions) {
    Session session;
    const Result<Asset> missing = session.open("no/such.glb");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().id, "E-SCENE-MISSING");
    EXPECT_EQ(missing.error().code, 66);
    AssetOptions options;
    options.variant = "Pink";
    const Result<Asset> pink = session.open(assets + "cornell/cornell.gltf", options);
    ASSERT_FALSE(pink);
    EXPECT_EQ(pink.error().place, "variant");

    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    const auto error_of = [&](void (*change)(View&)) {
        View view = small_view();
        change(view);
        const Result<Image> image = session.render(*asset, view);
        EXPECT_FALSE(image);
        const Error error = image ? Error{} : image.error();
        EXPECT_THAT(error.place + error.text, Not(HasSubstr("--")));
        EXPECT_EQ(error.code, 64);
        return error.place + " " + error.id;
    };
    EXPECT_EQ(error_of([](View& v) { v.camera = "none"; }), "camera E-CAM-UNKNOWN");
    EXPECT_EQ(error_of([](View& v) { v.width = 0; }), "width E-USAGE-RANGE");
    EXPECT_EQ(error_of([](View& v) { v.focal_length_m = 0.05; }), "focal_length_m E-CAM-LENS");
    EXPECT_EQ(error_of([](View& v) { v.camera_model = CameraModel::thin_lens; }),
              "camera_model E-CAM-LENS");
    EXPECT_EQ(error_of([](View& v) { v.eye = v.target = Vector3{1, 1, 1}; }), "eye E-CAM-VIEW");
    EXPECT_EQ(error_of([](View& v) { v.focus_on_px = {{1, 1}}; }), "camera_model E-CAM-LENS");
    EXPECT_EQ(error_of([](View& v) { v.crop = Rect{30, 0, 11, 1}; }), "crop E-USAGE-CONFLICT");
    EXPECT_EQ(error_of([](View& v) {
                  v.camera_model = CameraModel::fisheye;
                  v.fstop = 2;
              }),
              "fstop E-USAGE-CONFLICT");
    EXPECT_EQ(error_of([](View& v) {
                  v.ev100 = 10;
                  v.exposure_s = 0.01;
              }),
              "ev100 E-USAGE-CONFLICT");
    EXPECT_EQ(error_of([](View& v) {
                  v.fisheye = "equidistant";
                  v.fisheye_coefficients = {{1, 0, 0, 0}};
              }),
              "fisheye_coefficients E-USAGE-CONFLICT");
    EXPECT_EQ(error_of([](View& v) { v.fisheye_fit = "oval"; }), "fisheye_fit E-USAGE-CHOICE");
    EXPECT_EQ(error_of([](View& v) {
                  v.eye = Vector3{1, 1, 1};
                  v.camera_json = "c.json";
              }),
              "camera_json E-USAGE-CONFLICT");
    EXPECT_EQ(error_of([](View& v) { v.stereo_m = -1; }), "stereo_m E-USAGE-RANGE");
    EXPECT_TRUE(session.render(*asset, small_view(), {}, few_samples())) << "it can go on";
}

TEST(Library, ExposureCountsInImagesForADisplay) {
    const std::string file = assets + "cornell/cornell.gltf";
    const TempFolder folder;
    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    std::vector<std::string> written;
    for (const double ev100 : {0.0, 3.0}) {
        View view = small_view();
        view.ev100 = ev100;
        const Image image = image_of(session.render(*asset, view, {}, few_samples()));
        const std::string png = (folder / "a.png").string();
        const Result<void> done = session.write(image, png);
        ASSERT_TRUE(done) << done.error().text;
        written.push_back(read_whole_file(png));
    }
    EXPECT_NE(written[0], written[1]);
}

TEST(Library, AttributesKeepTheirTypesUnlessTheyAreChanged) {
    const TempFolder folder;
    Session session;
    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    View view = small_view();
    view.ev100 = 3;
    Image image = image_of(session.render(*asset, view, {}, few_samples()));
    const auto attribute = [&](const std::string& name) -> std::string& {
        const auto found = std::find_if(image.attributes.begin(),
                                        image.attributes.end(),
                                        [&](const auto& entry) { return entry.first == name; });
        EXPECT_NE(found, image.attributes.end()) << name;
        return found->second;
    };
    EXPECT_EQ(attribute("obscura:ev100"), "3");
    attribute("obscura:exposureScale") = "unknown";
    image.attributes.emplace_back("shot", "7");
    const std::string file = (folder / "a.exr").string();
    ASSERT_TRUE(session.write(image, file));
    const Imf::InputFile written(file.c_str());
    const Imf::Header& header = written.header();
    EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("obscura:ev100").value(), 3);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("obscura:exposureScale").value(),
              "unknown");
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("shot").value(), "7");
    EXPECT_NE(header.findTypedAttribute<Imf::IntAttribute>("obscura:warnings"), nullptr);
}

TEST(Library, FilesForDisplaysFollowTheirOptions) {
    const TempFolder folder;
    Session session;
    const Result<Asset> asset =
        session.open(folder.write("t.gltf", gltf_text(triangle_scene())).string());
    ASSERT_TRUE(asset);
    Look clear;
    clear.background = Background::transparent;
    const Image image = image_of(session.render(*asset, small_view(), clear, few_samples()));
    const auto write = [&](const std::string& name, const WriteOptions& options) {
        return session.write(image, (folder / name).string(), options);
    };
    const auto size = [&](const std::string& name) {
        return std::filesystem::file_size(folder / name);
    };
    WriteOptions options;
    EXPECT_TRUE(write("a.png", options));
    options.bits = 16;
    EXPECT_TRUE(write("b.png", options));
    EXPECT_GT(size("b.png"), size("a.png"));
    EXPECT_EQ(write("b.webp", options).error().id, "E-USAGE-CONFLICT");
    options.bits = 12;
    EXPECT_EQ(write("c.png", options).error().id, "E-USAGE-CONFLICT");
    options.bits = 8;
    options.quality = 0;
    EXPECT_EQ(write("c.webp", options).error().id, "E-USAGE-RANGE");
    options.quality = 100;
    options.page = std::array<float, 3>{1, 1, 2};
    EXPECT_EQ(write("c.webp", options).error().id, "E-USAGE-RANGE");
    options.page = std::array<float, 3>{1, 1, 1};
    EXPECT_TRUE(write("c.webp", options));
    EXPECT_EQ(write("-", options).error().id, "E-OUT-FORMAT") << "the library prints nothing";
}

TEST(Library, TilesCoverTheImageWithItsPixels) {
    Session session;
    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    View view = small_view();
    view.crop = Rect{3, 2, 33, 21};
    std::vector<float> pixels(size_t{33 * 21 * 4}, -1);
    double share = 0;
    Control control;
    control.threads = 2;
    control.tile_size = 8;
    control.progress = [&](double done) { share = std::max(share, done); };
    control.tile = [&](const Tile& tile) {
        ASSERT_EQ(tile.channels.size(), 4U);
        for (int y = 0; y < tile.area.height; ++y) {
            const size_t to = static_cast<size_t>((tile.area.y - 2 + y) * 33 + tile.area.x - 3) * 4;
            std::memcpy(&pixels[to],
                        tile.pixels + static_cast<size_t>(y) * tile.row_floats,
                        static_cast<size_t>(tile.area.width) * 4 * sizeof(float));
        }
    };
    const Image image = image_of(session.render(*asset, view, {}, few_samples(), control));
    EXPECT_EQ(image.pixels, pixels);
    EXPECT_EQ(share, 1);
    EXPECT_EQ(image.part.x, 3);
    EXPECT_EQ(image.width, 40);
    const Image whole = fresh_image(assets + "cornell/cornell.gltf", small_view());
    EXPECT_EQ(image.pixels[0], whole.pixels[size_t{(2 * 40 + 3) * 4}]);
}

TEST(Library, ProgressNeverFalls) {
    Session session;
    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    double share = 0;
    int falls = 0;
    Control control;
    control.threads = 2;
    control.tile_size = 1;
    control.progress = [&](double done) {
        falls += done < share ? 1 : 0;
        share = done;
        // The other thread waits meanwhile, and is not always the next.
        if (done < 0.5) std::this_thread::sleep_for(std::chrono::microseconds(50));
    };
    for (int i = 0; i < 5; ++i) {
        share = 0;
        ASSERT_TRUE(session.render(*asset, small_view(), {}, few_samples(), control));
    }
    EXPECT_EQ(falls, 0);
    EXPECT_EQ(share, 1);
}

TEST(Library, ANoiseTargetIsReachedWithinItsNumbersOfSamples) {
    Session session;
    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    Sampling sampling = few_samples();
    sampling.samples_per_pixel = 32;
    sampling.noise_target = 0.25;
    sampling.spp_min = 4;
    sampling.aov = {"sample_count"};
    const Image image = image_of(session.render(*asset, small_view(), {}, sampling));
    const std::vector<float>& counts = image.layers.at(0).pixels;
    EXPECT_EQ(*std::min_element(counts.begin(), counts.end()), 4);
    EXPECT_GT(*std::max_element(counts.begin(), counts.end()), 4);
    EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 32);
    EXPECT_THAT(image.attributes, Contains(Pair("obscura:noiseTarget", "0.25")));
    EXPECT_THAT(image.attributes, Contains(Pair("obscura:samplesMin", "4")));
    sampling.spp_min = 33;
    const Result<Image> refused = session.render(*asset, small_view(), {}, sampling);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "E-USAGE-CONFLICT");
    EXPECT_EQ(refused.error().place, "spp_min");
    sampling.noise_target = 2;
    EXPECT_EQ(session.render(*asset, small_view(), {}, sampling).error().id, "E-USAGE-RANGE");
    sampling.noise_target.reset();
    sampling.spp_min = 4;
    const Result<Image> no_target = session.render(*asset, small_view(), {}, sampling);
    ASSERT_FALSE(no_target) << "spp_min has no use";
    EXPECT_EQ(no_target.error().place, "spp_min");
}

TEST(Library, ACancelledImageIsAnErrorAndTheAssetGoesOn) {
    const std::string file = assets + "cornell/cornell.gltf";
    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    std::atomic<bool> cancel = false;
    Control control;
    control.cancel = &cancel;
    control.tile_size = 4;
    control.tile = [&](const Tile&) { cancel = true; };
    const Result<Image> stopped = session.render(*asset, small_view(), {}, few_samples(), control);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().id, "E-STOPPED");
    EXPECT_EQ(image_of(session.render(*asset, small_view(), {}, few_samples())).pixels,
              fresh_image(file, small_view()).pixels);
}

TEST(Library, ExceptionsOfCallbacksAreErrorsAndTheAssetGoesOn) {
    const std::string file = assets + "cornell/cornell.gltf";
    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    Control control;
    control.tile_size = 4;
    control.tile = [](const Tile&) { throw std::bad_alloc(); };
    const Result<Image> full = session.render(*asset, small_view(), {}, few_samples(), control);
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().id, "E-MEM");
    EXPECT_EQ(full.error().code, 33);
    control.tile = [](const Tile&) { throw std::runtime_error("the window is gone"); };
    const Result<Image> thrown = session.render(*asset, small_view(), {}, few_samples(), control);
    ASSERT_FALSE(thrown);
    EXPECT_EQ(thrown.error().id, "E-INTERNAL");
    EXPECT_EQ(thrown.error().text, "the window is gone");
    control.tile = [](const Tile&) { throw 7; };
    const Result<Image> foreign = session.render(*asset, small_view(), {}, few_samples(), control);
    ASSERT_FALSE(foreign);
    EXPECT_EQ(foreign.error().id, "E-INTERNAL");
    EXPECT_EQ(image_of(session.render(*asset, small_view(), {}, few_samples())).pixels,
              fresh_image(file, small_view()).pixels);
}

/// An image equals that of a fresh asset, whatever was rendered of its asset before.
TEST(Library, ImagesDoNotDependOnEarlierOnes) {
    const std::string file = assets + "motion/motion.glb";
    View still = small_view();
    View later = still;
    later.time_s = 0.75;
    View blurred = later;
    blurred.shutter_s = {{0, 0.1}};
    View aside = later;
    aside.eye = Vector3{3, 2, 4};
    Look sky;
    sky.environment = assets + "environments/sky.hdr";
    Look turned = sky;
    turned.environment_rotation_deg = 70;
    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    const std::vector<std::pair<View, Look>> turns = {{still, {}},
                                                      {later, {}},
                                                      {aside, {}},
                                                      {later, sky},
                                                      {later, turned},
                                                      {blurred, turned},
                                                      {still, {}},
                                                      {later, {}}};
    std::vector<std::vector<float>> seen;
    for (const auto& [view, look] : turns) {
        const Image image = image_of(session.render(*asset, view, look, few_samples()));
        EXPECT_EQ(image.pixels, fresh_image(file, view, look).pixels) << seen.size();
        seen.push_back(image.pixels);
    }
    EXPECT_NE(seen[0], seen[1]) << "it moves";
    EXPECT_NE(seen[3], seen[4]) << "the light turns";
}

TEST(Library, TextureCoordinatesAndDepthComeFromTheSameAsset) {
    Session session;
    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    Sampling sampling;
    sampling.integrator = Integrator::depth;
    const Image depth = image_of(session.render(*asset, small_view(), {}, sampling));
    EXPECT_EQ(depth.channels, std::vector<std::string>{"Z"});
    EXPECT_GT(depth.pixels[40 * 12 + 20], 0);
    sampling.integrator = Integrator::uv;
    const Image uv = image_of(session.render(*asset, small_view(), {}, sampling));
    EXPECT_EQ(uv.channels.size(), 2U);
}

TEST(Library, TwoSessionsWorkSideBySide) {
    const std::string files[] = {assets + "cornell/cornell.gltf", assets + "motion/motion.glb"};
    View views[] = {small_view(), small_view()};
    views[1].width = 33;
    const Image alone[] = {fresh_image(files[0], views[0]), fresh_image(files[1], views[1])};
    std::atomic<int> same = 0;
    std::vector<std::thread> threads;
    for (size_t i = 0; i < 2; ++i) {
        threads.emplace_back([&, i] {
            Control control;
            control.threads = i == 0 ? 1 : 3;
            for (int round = 0; round < 3; ++round) {
                Session session;
                const Result<Asset> asset = session.open(files[i]);
                if (!asset) return;
                const Result<Image> image =
                    session.render(*asset, views[i], {}, few_samples(), control);
                if (image && image->pixels == alone[i].pixels) ++same;
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(same, 6);
}

/// What belongs to the process stays as it was, and nothing is printed.
TEST(Library, TheProcessIsLeftAlone) {
    const TempFolder folder;
    const auto settings = [] {
        return std::tuple(
            Imf::globalThreadCount(),
            OIIO::get_int_attribute("threads"),
            OIIO::get_string_attribute("plugin_searchpath"),
            tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    };
    ::setenv("OIIO_LIBRARY_PATH", "/nowhere", 1);
    const auto before = settings();
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    int messages = 0;
    Session session([&](const Message&) { ++messages; });
    const Result<Asset> asset =
        session.open(folder.write("box.gltf", gltf_text(box_scene())).string());
    ASSERT_TRUE(asset);
    View view = small_view();
    view.width = 1024;
    view.height = 512;  // large enough for several threads to write it
    Sampling one;
    one.samples_per_pixel = 1;
    one.integrator = Integrator::direct;
    Look look;
    look.environment = assets + "environments/sky.hdr";
    const Image image = image_of(session.render(*asset, view, look, one));
    for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif", "a.webp"}) {
        const Result<void> written = session.write(image, (folder / name).string());
        EXPECT_TRUE(written) << written.error().text;
    }
    EXPECT_FALSE(session.write(image, (folder / "a.bmp").string()));
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(settings(), before);
    EXPECT_STREQ(std::getenv("OIIO_LIBRARY_PATH"), "/nowhere");
    ::unsetenv("OIIO_LIBRARY_PATH");
}

TEST(Library, WarningsGoToTheSink) {
    std::vector<std::string> told;
    Session session([&](const Message& message) { told.push_back(message.text); });
    const TempFolder folder;
    const Result<Asset> asset =
        session.open(folder.write("t.gltf", gltf_text(triangle_scene())).string());
    ASSERT_TRUE(asset);
    for (int i = 0; i < 2; ++i)
        image_of(session.render(*asset, small_view(), {}, few_samples()));
    ASSERT_EQ(told.size(), 1U) << "the studio is spoken of once";
    EXPECT_THAT(told[0], HasSubstr("built-in studio"));
    EXPECT_THAT(told[0], Not(HasSubstr("--")));
}

}  // namespace
}  // namespace obscura
