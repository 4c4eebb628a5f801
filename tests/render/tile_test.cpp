// tests/render/tile_test.cpp - tiles cover an area once, neighbours one after the other.
// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace obscura::test {
namespace {

using Place = std::pair<int, int>;

TEST(Tiles, FollowOneAnotherAlongAZ) {
    const std::vector<Tile> tiles = cut_tiles({5, 7, 37, 21}, 16);
    const std::vector<Tile> expected = {{5, 7, 16, 16},
                                        {21, 7, 16, 16},
                                        {5, 23, 16, 5},
                                        {21, 23, 16, 5},
                                        {37, 7, 5, 16},
                                        {37, 23, 5, 5}};
    EXPECT_EQ(tiles, expected);
}

TEST(Tiles, CoverAnAreaOnceSquareBySquare) {
    const PixelRect area{-3, 2, 203, 77};
    const int size = 4;
    std::map<Place, int> times;
    std::map<Place, int> last_in_square;  // of 8 by 8 tiles: the number of its latest tile
    const std::vector<Tile> tiles = cut_tiles(area, size);
    for (size_t i = 0; i < tiles.size(); ++i) {
        for (int y = 0; y < tiles[i].height; ++y) {
            for (int x = 0; x < tiles[i].width; ++x)
                ++times[{tiles[i].x + x, tiles[i].y + y}];
        }
        const Place square{(tiles[i].x - area.x) / (8 * size), (tiles[i].y - area.y) / (8 * size)};
        const auto number = static_cast<int>(i);
        const auto [place, is_new] = last_in_square.try_emplace(square, number);
        EXPECT_TRUE(is_new || place->second == number - 1) << "left its square at tile " << i;
        place->second = number;
    }
    EXPECT_EQ(times.size(), size_t{203} * 77);
    for (const auto& [place, count] : times) {
        EXPECT_EQ(count, 1) << place.first << " " << place.second;
        EXPECT_TRUE(place.first >= -3 && place.first < 200 && place.second >= 2 &&
                    place.second < 79);
    }
}

}  // namespace
}  // namespace obscura::test
