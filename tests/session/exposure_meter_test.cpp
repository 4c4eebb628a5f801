// tests/session/exposure_meter_test.cpp - how much light a film shows, and the exposure for it.
// SPDX-License-Identifier: Apache-2.0
#include "session/exposure_meter.h"

#include <gtest/gtest.h>

#include <vector>

namespace obscura {
namespace {

struct Pixel {
    float value, alpha, albedo;  ///< grey; the first and the last are multiplied by alpha
};

Film film_of(const std::vector<Pixel>& pixels) {
    Film film;
    film.width = static_cast<int>(pixels.size());
    film.height = 1;
    film.channels = {"R", "G", "B", "A"};
    film.pixels.resize(4 * pixels.size());
    film.layers.resize(1);
    film.layers[0].pixels.resize(3 * pixels.size());
    for (size_t i = 0; i < pixels.size(); ++i) {
        for (size_t c = 0; c < 3; ++c) {
            film.pixels[4 * i + c] = pixels[i].value;
            film.layers[0].pixels[3 * i + c] = pixels[i].albedo;
        }
        film.pixels[4 * i + 3] = pixels[i].alpha;
    }
    return film;
}

TEST(ExposureMeter, TellsTheLightWhateverTheAlbedo) {
    // Twice the light of a surface that shows its albedo is one stop.
    EXPECT_NEAR(*metered_stops(film_of({{1.6f, 1, 0.8f}})), 1, 1e-6);
    EXPECT_NEAR(*metered_stops(film_of({{0.1f, 1, 0.05f}})), 1, 1e-6);
}

TEST(ExposureMeter, IsALogarithmicMeanWeightedByCoverage) {
    EXPECT_NEAR(*metered_stops(film_of({{0.5f, 1, 0.5f}, {0.125f, 1, 0.5f}})), -1, 1e-6);
    // Three quarters at 0 stops, a quarter at 4; what is empty does not count.
    const Film film = film_of({{0.375f, 0.75f, 0.375f}, {2, 0.25f, 0.125f}, {5, 0, 0}});
    EXPECT_NEAR(*metered_stops(film), 1, 1e-6);
}

TEST(ExposureMeter, ShadowsCountAsTenStopsBelowTheMean) {
    EXPECT_NEAR(*metered_stops(film_of({{0.5f, 1, 0.25f}, {0, 1, 0.25f}})), (1 - 10) / 2.0, 1e-6);
}

TEST(ExposureMeter, WithoutAlbedoMiddleGreyIsRight) {
    EXPECT_NEAR(*metered_stops(film_of({{0.36f, 1, 0}})), 1, 1e-6);
    Film film = film_of({{0.36f, 1, 0.5f}});
    film.layers.clear();
    EXPECT_NEAR(*metered_stops(film), 1, 1e-6);
}

TEST(ExposureMeter, NothingIsMeteredWhereNothingIsLit) {
    EXPECT_FALSE(metered_stops(film_of({{0, 0, 0}})));
    EXPECT_FALSE(metered_stops(film_of({{0, 1, 0.5f}})));
}

TEST(ExposureMeter, ExposuresAreHundredthsOfAStop) {
    EXPECT_EQ(exposure_for({1.0, -0.5}), -0.25);
    EXPECT_EQ(exposure_for({-1.23456}), 1.23);
    EXPECT_EQ(exposure_for({-99.0}), 50);
}

TEST(ExposureMeter, SamplesSeedAndBackgroundOfTheImageDoNotMatter) {
    RenderRequest request;
    request.options.width = 1280;
    request.options.height = 640;
    RenderRequest other = request;
    other.options.width *= 2;
    other.options.height *= 2;
    other.options.samples_per_pixel = 7;
    other.options.seed = 3;
    other.options.background = BackgroundKind::color;
    for (const RenderRequest& one : {metering_image(request), metering_image(other)}) {
        EXPECT_EQ(one.options.width, 128);
        EXPECT_EQ(one.options.height, 64);
        EXPECT_EQ(one.options.samples_per_pixel, 16);
        EXPECT_EQ(one.options.seed, 0U);
        EXPECT_EQ(one.options.background, BackgroundKind::transparent);
        EXPECT_EQ(one.options.layers.size(), 1U);
    }
}

}  // namespace
}  // namespace obscura
