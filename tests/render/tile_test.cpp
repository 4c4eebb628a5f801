// tests/render/tile_test.cpp - tiles cover an area once, neighbours one after the other.
// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include <map>
#include <mutex>
#include <set>
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

TEST(Tiles, OfAFilmThatIsKeptDoNotDependOnTheirOption) {
    SceneBuilder builder;
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material({}));
    RenderOptions options;
    options.width = 150;
    options.height = 90;
    options.integrator = Integrator::normal;
    const Camera camera = look_at({0, 2, 3}, {0, 0, 0}, 0.8f, options.width, options.height);
    Log log(Verbosity::quiet);
    const PreparedScene scene =
        PreparedScene::create(builder.take(), {}, Isa::automatic, log).value();
    std::set<Place> corners[2];
    for (int k = 0; k < 2; ++k) {
        options.tile_size = k == 0 ? 16 : 80;
        FilmShare share{FilmPart{}, [](Film&) { return std::vector<FilmArea>(); }};
        options.share = &share;
        std::mutex mutex;
        const auto note = [&](const FinishedTile& tile) {
            const std::lock_guard lock(mutex);
            corners[k].insert({tile.area.x, tile.area.y});
        };
        ASSERT_TRUE(render(scene, camera, options, note, std::atomic<bool>(false)));
    }
    EXPECT_EQ(corners[0].size(), 15u);
    EXPECT_EQ(corners[0], corners[1]);
}

}  // namespace
}  // namespace obscura::test
