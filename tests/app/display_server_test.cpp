// tests/app/display_server_test.cpp - images go to a viewer, and nobody waits for one that is slow.
// SPDX-License-Identifier: Apache-2.0
#include "app/display_server.h"

#include <gtest/gtest.h>

#include "support/fake_viewer.h"
#include <chrono>
#include <gmock/gmock.h>

namespace obscura::app {
namespace {

using Manner = FakeViewer::Manner;
using testing::ElementsAre;
using testing::HasSubstr;

OutputImage image_of(int side, float value) {
    OutputImage image;
    image.width = side;
    image.height = side;
    image.channels = {"R", "G", "B", "A"};
    image.pixels.assign(static_cast<size_t>(side * side) * 4, value);
    return image;
}

double seconds_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

DisplayAddress address_of(const FakeViewer& viewer) {
    return {"127.0.0.1", viewer.port()};
}

TEST(DisplayServer, EveryImageIsThereInTheEnd) {
    FakeViewer viewer(Manner::reads);
    Log log;
    DisplayServer server(address_of(viewer), log);
    for (int i = 1; i <= 20; ++i) {
        server.begin_image("image " + std::to_string(i));
        server.add(image_of(100, static_cast<float>(i)));
    }
    server.finish(false);
    const auto images = viewer.images();
    EXPECT_EQ(images.size(), 20);
    for (int i = 1; i <= 20; ++i)
        EXPECT_EQ(images.at("image " + std::to_string(i)).pixels,
                  std::vector<float>(40000, static_cast<float>(i)));
    EXPECT_TRUE(log.warnings().empty());
}

TEST(DisplayServer, OneThatIsNotThereIsAWarning) {
    FakeViewer viewer(Manner::reads);
    viewer.finish();
    Log log;
    DisplayServer server(address_of(viewer), log);
    server.begin_image("a");
    server.add(image_of(100, 1));
    EXPECT_LT(seconds_of([&] { server.finish(false); }), 8);
    EXPECT_THAT(log.warnings(), ElementsAre(HasSubstr("cannot be reached")));
}

TEST(DisplayServer, ALostOneIsAWarning) {
    FakeViewer viewer(Manner::closes_early);
    Log log;
    DisplayServer server(address_of(viewer), log);
    for (int i = 0; i < 3; ++i) {
        server.begin_image("a" + std::to_string(i));
        server.add(image_of(1000, 1));
    }
    server.finish(false);
    EXPECT_THAT(log.warnings(), ElementsAre(HasSubstr("is lost")));
}

TEST(DisplayServer, ASlowOneIsWaitedForAFewSecondsAndKeepsLittleMemory) {
    FakeViewer viewer(Manner::never_reads);
    Log log;
    DisplayServer server(address_of(viewer), log);
    EXPECT_LT(seconds_of([&] {
                  for (int i = 0; i < 8; ++i) {  // 16 MB each
                      server.begin_image("a" + std::to_string(i));
                      server.add(image_of(1000, 1));
                  }
              }),
              10);
    EXPECT_LT(seconds_of([&] { server.finish(false); }), 12);
    EXPECT_THAT(log.warnings(), ElementsAre(HasSubstr("slower"), HasSubstr("too slowly")));
}

TEST(DisplayServer, WithASignalNobodyWaits) {
    FakeViewer viewer(Manner::never_reads);
    Log log;
    DisplayServer server(address_of(viewer), log);
    server.begin_image("a");
    server.add(image_of(2000, 1));
    EXPECT_LT(seconds_of([&] { server.finish(true); }), 8);
    EXPECT_TRUE(log.warnings().empty());
}

}  // namespace
}  // namespace obscura::app
