// tests/app/display_connection_test.cpp - addresses of viewers, and connections that fail.
// SPDX-License-Identifier: Apache-2.0
#include "app/display_connection.h"

#include <gtest/gtest.h>

#include "support/fake_viewer.h"

namespace obscura::app {
namespace {

using Manner = FakeViewer::Manner;

TEST(DisplayAddress, HasAPortOrThatOfTheViewer) {
    for (const auto& [text, same] : {std::pair{"127.0.0.1:7000", "127.0.0.1:7000"},
                                     std::pair{"localhost", "localhost:14158"},
                                     std::pair{"[::1]:80", "[::1]:80"},
                                     std::pair{"[::1]", "[::1]:14158"}}) {
        const Result<DisplayAddress> address = parse_display_address(text, "--display-server");
        ASSERT_TRUE(address) << text;
        EXPECT_EQ(text_of(*address), same);
    }
}

TEST(DisplayAddress, OthersAreRefused) {
    for (const auto& [text, id] : {std::pair{"", "E-USAGE-NUMBER"},
                                   std::pair{":7000", "E-USAGE-NUMBER"},
                                   std::pair{"host:", "E-USAGE-NUMBER"},
                                   std::pair{"host:x", "E-USAGE-NUMBER"},
                                   std::pair{"host:0", "E-USAGE-RANGE"},
                                   std::pair{"host:65536", "E-USAGE-RANGE"},
                                   std::pair{"::1", "E-USAGE-NUMBER"},
                                   std::pair{"[]:7", "E-USAGE-NUMBER"},
                                   std::pair{"[::1]x", "E-USAGE-NUMBER"},
                                   std::pair{"[::1", "E-USAGE-NUMBER"}}) {
        const Result<DisplayAddress> address = parse_display_address(text, "--display-server");
        ASSERT_FALSE(address) << text;
        EXPECT_EQ(address.error().id, id) << text;
        EXPECT_EQ(address.error().code, ExitCode::usage);
    }
}

TEST(DisplayConnection, AllBytesArrive) {
    FakeViewer viewer(Manner::reads);
    const Bytes bytes(3000000, std::byte{7});
    std::atomic<uint64_t> sent = 0;
    {
        const std::atomic<bool> gives_up = false;
        DisplayConnection connection(gives_up);
        ASSERT_EQ(connection.open({"127.0.0.1", viewer.port()}), "");
        ASSERT_EQ(connection.send(bytes, sent), "");
    }
    EXPECT_EQ(sent, bytes.size());
    EXPECT_EQ(viewer.bytes(), std::string(bytes.size(), '\7'));
}

TEST(DisplayConnection, SaysWhyItFails) {
    const std::atomic<bool> gives_up = false;
    DisplayConnection connection(gives_up);
    FakeViewer viewer(Manner::reads);
    viewer.finish();
    EXPECT_NE(connection.open({"127.0.0.1", viewer.port()}), "");
    EXPECT_NE(connection.open({"no.such.name.invalid", 80}), "");
}

TEST(DisplayConnection, AClosedOneEndsSending) {
    FakeViewer viewer(Manner::closes_early);
    const std::atomic<bool> gives_up = false;
    DisplayConnection connection(gives_up);
    ASSERT_EQ(connection.open({"127.0.0.1", viewer.port()}), "");
    std::atomic<uint64_t> sent = 0;
    EXPECT_NE(connection.send(Bytes(50000000), sent), "");
}

TEST(DisplayConnection, GivesUpWhenItIsToldTo) {
    FakeViewer viewer(Manner::never_reads);
    std::atomic<bool> gives_up = false;
    DisplayConnection connection(gives_up);
    ASSERT_EQ(connection.open({"127.0.0.1", viewer.port()}), "");
    std::atomic<uint64_t> sent = 0;
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        gives_up = true;
    });
    EXPECT_NE(connection.send(Bytes(50000000), sent), "");
    later.join();
}

}  // namespace
}  // namespace obscura::app
