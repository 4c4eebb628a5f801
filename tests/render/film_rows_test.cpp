// tests/render/film_rows_test.cpp - sample columns reach their pixels, however the film is written.
// SPDX-License-Identifier: Apache-2.0
#include "render/film_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace obscura::test {
namespace {

/// A tile whose pixels lie in blocks of 4 x 4, as tiles are cut.
struct Tile {
    std::vector<int32_t> x, y;

    Tile(int left, int top, int width, int height) {
        for (int block_y = 0; block_y < height; block_y += 4) {
            for (int block_x = 0; block_x < width; block_x += 4) {
                for (int row = block_y; row < std::min(block_y + 4, height); ++row) {
                    for (int column = block_x; column < std::min(block_x + 4, width); ++column) {
                        x.push_back(left + column);
                        y.push_back(top + row);
                    }
                }
            }
        }
    }
    /// Leaves out the first ones, as when a tile is rendered in parts.
    Tile from(size_t first) const {
        Tile rest = *this;
        rest.x.erase(rest.x.begin(), rest.x.begin() + static_cast<std::ptrdiff_t>(first));
        rest.y.erase(rest.y.begin(), rest.y.begin() + static_cast<std::ptrdiff_t>(first));
        return rest;
    }
    FilmPixels pixels() const { return {x.data(), y.data(), static_cast<int>(x.size())}; }
};

void expect_written(int width, int height, size_t channels, const Tile& tile) {
    Film film{width, height, std::vector<std::string>(channels, "Y"), {}};
    film.pixels.assign(static_cast<size_t>(width) * static_cast<size_t>(height) * channels, -1.0F);
    std::vector<float> columns[4];
    for (size_t c = 0; c < 4; ++c) {
        for (size_t i = 0; i < tile.x.size(); ++i)
            columns[c].push_back(static_cast<float>(4 * i + c));
    }
    const SampleColumns samples{
        columns[0].data(), columns[1].data(), columns[2].data(), columns[3].data()};
    write_film(samples, tile.pixels(), film);
    for (size_t i = 0; i < tile.x.size(); ++i) {
        const auto pixel = static_cast<size_t>(tile.y[i]) * static_cast<size_t>(width) +
                           static_cast<size_t>(tile.x[i]);
        for (size_t c = 0; c < channels; ++c)
            ASSERT_EQ(film.pixels[pixel * channels + c], columns[c][i]) << i << " " << c;
    }
    const auto written = std::count_if(
        film.pixels.begin(), film.pixels.end(), [](float value) { return value >= 0; });
    EXPECT_EQ(static_cast<size_t>(written), channels * tile.x.size());
}

TEST(FilmRows, EveryNumberOfChannelsComesToItsPixels) {
    for (size_t channels = 1; channels <= 4; ++channels) {
        expect_written(64, 48, channels, Tile(32, 16, 32, 32));
        expect_written(37, 29, channels, Tile(32, 16, 5, 13));
        expect_written(3, 2, channels, Tile(0, 0, 3, 2));
        expect_written(64, 48, channels, Tile(0, 0, 16, 8).from(15));
    }
}

TEST(FilmRows, LargeFilmsAlike) {
    for (size_t channels = 1; channels <= 4; ++channels) {
        expect_written(2048, 2100, channels, Tile(64, 32, 32, 32));
        expect_written(2047, 2100, channels, Tile(2016, 2080, 31, 20));
        expect_written(2048, 2100, channels, Tile(33, 7, 16, 9));
    }
}

}  // namespace
}  // namespace obscura::test
