// tests/film/film_state_test.cpp - parts of a film in files: shares, round trip, damage.
// SPDX-License-Identifier: Apache-2.0
#include "film/film_state.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include "support/text_files.h"
#include <numeric>

namespace obscura {
namespace {

Film numbered_film(float first) {
    Film film;
    film.width = 3;
    film.height = 5;
    film.channels = {"R", "G", "B", "A"};
    film.pixels.resize(3 * 5 * 4);
    std::iota(film.pixels.begin(), film.pixels.end(), first);
    film.layers.push_back({layers_of(std::vector<std::string>{"normal"}, 6)->front(), {}, {}});
    film.layers.back().pixels.resize(3 * 5 * 3);
    std::iota(film.layers.back().pixels.begin(), film.layers.back().pixels.end(), first + 1000);
    return film;
}

std::vector<float> floats_of(const UnsetArray<float>& pixels) {
    return {pixels.begin(), pixels.end()};
}

class FilmState : public testing::Test {
protected:
    std::string written(const FilmPart& part) {
        FilmStateHead head;
        head.part = part;
        head.options = {{"--spp", "4"}, {"SCENE", "a.glb"}};
        head.facts = {{"isa", "avx2"}};
        head.counters = {1, 2, 3, 4, 5, 6};
        EXPECT_TRUE(write_film_state(folder_ / "part", head, numbered_film(1)));
        return read_text(folder_ / "part");
    }
    std::string id_of(const std::string& bytes) {
        folder_.write("damaged", bytes);
        const Result<FilmStateHead> read = read_film_state(folder_ / "damaged", nullptr);
        return read ? "" : read.error().id;
    }

    TempFolder folder_;
};

TEST_F(FilmState, PartsShareEveryRowOnce) {
    for (const int height : {1, 5, 64, 1080}) {
        for (const int count : {1, 2, 3, 7, 1000}) {
            std::vector<int> times(static_cast<size_t>(height));
            for (int index = 0; index < count; ++index) {
                for (const RowRange& rows : rows_of_part(height, {index, count})) {
                    for (int y = rows.first; y < rows.first + rows.count; ++y)
                        ++times[static_cast<size_t>(y)];
                }
            }
            EXPECT_EQ(times, std::vector<int>(times.size(), 1)) << height << " rows, " << count;
        }
    }
}

TEST_F(FilmState, ComesBackFromItsParts) {
    Film film = numbered_film(0);
    for (const int index : {1, 0}) {
        written({index, 2});
        const Result<FilmStateHead> head = read_film_state(folder_ / "part", &film);
        ASSERT_TRUE(head) << head.error().message;
        EXPECT_EQ(head->part.index, index);
        EXPECT_EQ(head->options, (NamedTexts{{"--spp", "4"}, {"SCENE", "a.glb"}}));
        EXPECT_EQ(head->facts, (NamedTexts{{"isa", "avx2"}}));
        EXPECT_EQ(head->counters, (std::array<uint64_t, 6>{1, 2, 3, 4, 5, 6}));
    }
    const Film whole = numbered_film(1);
    EXPECT_EQ(floats_of(film.pixels), floats_of(whole.pixels));
    EXPECT_EQ(floats_of(film.layers[0].pixels), floats_of(whole.layers[0].pixels));
}

TEST_F(FilmState, RefusesCutsAndFlippedBytes) {
    const std::string whole = written({0, 2});
    ASSERT_EQ(id_of(whole), "");
    for (size_t length = 0; length < whole.size(); length += 5)
        EXPECT_EQ(id_of(whole.substr(0, length)), "E-PART-DAMAGED") << length;
    EXPECT_EQ(id_of(whole + "x"), "E-PART-DAMAGED");
    for (size_t at = 0; at < whole.size(); at += 5) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 4);
        EXPECT_EQ(id_of(flipped), "E-PART-DAMAGED") << at;
    }
}

// Rows are filled by these numbers: whatever the checksum says, they must not lead out of the film.
TEST_F(FilmState, RefusesPartsThatThereAreNot) {
    EXPECT_EQ(id_of(written({5, 2})), "E-PART-DAMAGED");
    EXPECT_EQ(id_of(written({2, 2})), "E-PART-DAMAGED");
    EXPECT_EQ(id_of(written({0, max_film_parts + 1})), "E-PART-DAMAGED");
    EXPECT_EQ(id_of(written({1, 2})), "");
}

TEST_F(FilmState, RefusesAnotherFilm) {
    written({0, 1});
    Film other = numbered_film(0);
    other.layers.clear();
    const Result<FilmStateHead> read = read_film_state(folder_ / "part", &other);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().id, "E-PART-MIX");
    EXPECT_EQ(read.error().code, ExitCode::configuration);
}

}  // namespace
}  // namespace obscura
