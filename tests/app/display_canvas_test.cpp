// tests/app/display_canvas_test.cpp - a viewer is sent what is new to it, once, and in the end all.
// SPDX-License-Identifier: Apache-2.0
#include "app/display_canvas.h"

#include <gtest/gtest.h>

#include "support/fake_viewer.h"

namespace obscura::app {
namespace {

Film film_of(int width, int height, std::optional<ImagePart> part = {}) {
    Film film;
    film.width = width;
    film.height = height;
    film.channels = {"R", "G"};
    film.part_of = part;
    film.pixels.resize(static_cast<size_t>(width * height) * 2);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        film.pixels[i] = static_cast<float>(i + 1);
    return film;
}

void put(const PixelRect& area, const Film& film, DisplayCanvas& canvas) {
    canvas.put(area, {film.part_of, film.width, film.pixels.data()});
}

/// Appends all packets that there are; returns how many.
int take_all(DisplayCanvas& canvas, std::string& to) {
    int count = 0;
    while (const std::optional<Bytes> packet = canvas.take_packet()) {
        to.append(reinterpret_cast<const char*>(packet->data()), packet->size());
        ++count;
    }
    EXPECT_FALSE(canvas.has_changes());
    return count;
}

std::vector<float> values_of(const Film& film) {
    return {film.pixels.begin(), film.pixels.end()};
}

TEST(DisplayCanvas, BeginsBlack) {
    DisplayCanvas canvas("a", film_of(5, 3));
    EXPECT_TRUE(canvas.has_changes());
    std::string sent;
    EXPECT_EQ(take_all(canvas, sent), 1);
    const ViewedImage image = images_of(sent).at("a");
    EXPECT_EQ(image.width, 5);
    EXPECT_EQ(image.height, 3);
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G"}));
    EXPECT_EQ(image.pixels, std::vector<float>(30, 0.0f));
}

TEST(DisplayCanvas, NeighboursAndRepeatedTilesGoTogether) {
    const Film film = film_of(200, 130);
    DisplayCanvas canvas("a", film);
    std::string sent;
    take_all(canvas, sent);
    for (int repeated = 0; repeated < 2; ++repeated) {
        for (int x = 0; x < 128; x += 16)
            put({x, 0, 16, 16}, film, canvas);
    }
    EXPECT_EQ(take_all(canvas, sent), 1);
    EXPECT_EQ(images_of(sent).at("a").part(0, 0, 128, 16),
              images_of(sent).at("a").part(0, 0, 128, 16));
    put({0, 0, 200, 130}, film, canvas);
    EXPECT_EQ(take_all(canvas, sent), 4);
    EXPECT_EQ(images_of(sent).at("a").pixels, values_of(film));
}

TEST(DisplayCanvas, WhatIsTheSameIsNotSentAgain) {
    Film film = film_of(300, 20);
    DisplayCanvas canvas("a", film);
    std::string sent;
    put({0, 0, 300, 20}, film, canvas);
    EXPECT_EQ(take_all(canvas, sent), 1 + 3);
    put({0, 0, 300, 20}, film, canvas);
    EXPECT_EQ(take_all(canvas, sent), 0);
    film.pixels[7] = -1;
    put({0, 0, 10, 20}, film, canvas);
    EXPECT_EQ(take_all(canvas, sent), 1);
    EXPECT_EQ(images_of(sent).at("a").pixels, values_of(film));
}

TEST(DisplayCanvas, ACropLiesWhereItLiesInTheWholeImage) {
    const Film film = film_of(6, 4, ImagePart{20, 10, 3, 5});
    DisplayCanvas canvas("a", film);
    std::string sent;
    put({3, 5, 6, 4}, film, canvas);
    take_all(canvas, sent);
    const ViewedImage image = images_of(sent).at("a");
    EXPECT_EQ(image.width, 20);
    EXPECT_EQ(image.height, 10);
    EXPECT_EQ(image.part(3, 5, 6, 4), values_of(film));
}

TEST(DisplayCanvas, OverscanIsShownAsAWhole) {
    const Film film = film_of(14, 8, ImagePart{10, 6, -2, -1});
    DisplayCanvas canvas("a", film);
    std::string sent;
    put({-2, -1, 14, 8}, film, canvas);
    take_all(canvas, sent);
    const ViewedImage image = images_of(sent).at("a");
    EXPECT_EQ(image.width, 14);
    EXPECT_EQ(image.height, 8);
    EXPECT_EQ(image.pixels, values_of(film));
}

TEST(DisplayCanvas, ATileMayHavePixelsOfItsOwn) {
    const Film film = film_of(40, 40);
    const Film tile = film_of(8, 4, ImagePart{40, 40, 16, 32});
    DisplayCanvas canvas("a", film);
    std::string sent;
    put({16, 32, 8, 4}, tile, canvas);
    take_all(canvas, sent);
    EXPECT_EQ(images_of(sent).at("a").part(16, 32, 8, 4), values_of(tile));
}

}  // namespace
}  // namespace obscura::app
