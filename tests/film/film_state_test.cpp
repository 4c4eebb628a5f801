// tests/film/film_state_test.cpp - films in files: shares, round trip, sums, damage.
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
    film.layers.push_back(
        {layers_of(std::vector<std::string>{"crypto_object"}, 6)->front(), {}, {}});
    film.layers.back().pixels.resize(3 * 5 * 12);
    std::iota(film.layers.back().pixels.begin(), film.layers.back().pixels.end(), first + 2000);
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
        head.areas = areas_of_part(3, 5, part.index < part.count ? part : FilmPart{});
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

TEST(PartsOfSamples, ShareEverySampleOnceInWholeBlocks) {
    for (const int samples : {1, 16, 17, 64, 1000, 1 << 20}) {
        for (const int count : {1, 2, 3, 7, 1000}) {
            int64_t next = 0;
            for (int index = 0; index < count; ++index) {
                const SampleRange range = samples_of_part(samples, {index, count, PartOf::samples});
                EXPECT_EQ(range.first, next);
                EXPECT_TRUE(range.count == 0 || range.first % sum_block_samples == 0);
                EXPECT_LE(range.count, (samples / 16 + 1) / count * 16 + 16);
                next += range.count;
            }
            EXPECT_EQ(next, samples);
        }
    }
    EXPECT_EQ(samples_of_part(100, {1, 2}).count, 100) << "a part of rows has all of them";
    EXPECT_EQ(rows_of_part(50, {1, 2, PartOf::samples}).front().count, 50);
}

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
    for (size_t k = 0; k < 2; ++k)
        EXPECT_EQ(floats_of(film.layers[k].pixels), floats_of(whole.layers[k].pixels));
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

/// The pixels of one area, in a film of zeros.
Film filled(const FilmArea& area) {
    return copy_areas(numbered_film(1), std::vector<FilmArea>{area});
}

TEST_F(FilmState, HoldsAreas) {
    FilmStateHead head;
    head.areas = {{1, 2, 2, 3}};
    ASSERT_TRUE(write_film_state(folder_ / "some", head, numbered_film(1)));
    Film film = copy_areas(numbered_film(0), {});
    const Result<FilmStateHead> read = read_film_state(folder_ / "some", &film);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->areas, head.areas);
    EXPECT_EQ(pixels_in(read->areas), 6);
    EXPECT_FALSE(is_whole(*read));
    const Film expected = filled(head.areas[0]);
    EXPECT_EQ(floats_of(film.pixels), floats_of(expected.pixels));
    for (size_t k = 0; k < 2; ++k)
        EXPECT_EQ(floats_of(film.layers[k].pixels), floats_of(expected.layers[k].pixels));
    EXPECT_EQ(film.pixels[4 * 7 + 1], 30);  // row 2, column 1: behind 28 numbers and one channel
    // Channel 5, in the second plane of four: behind the first one's 60 numbers.
    EXPECT_EQ(film.layers[1].pixels[60 + 4 * 7 + 1], 2090);
    EXPECT_EQ(film.layers[1].pixels[60 + 4 * 6 + 1], 0) << "column 0 is not of the area";
    EXPECT_EQ(film.pixels[4 * 6 + 1], 0);
}

TEST_F(FilmState, RefusesAreasOutsideTheFilm) {
    const std::vector<FilmArea> outside = {
        {0, 0, 0, 1}, {0, 0, 1, 6}, {3, 0, 1, 1}, {0, 5, 1, 1}, {0, 4, 1, 2}, {0, 0, 4, 1}};
    for (const FilmArea& area : outside) {
        FilmStateHead head;
        head.areas = {area};
        Film film = numbered_film(1);
        film.pixels.resize(10000);  // so that writing stays in it
        film.layers.clear();
        ASSERT_TRUE(write_film_state(folder_ / "x", head, film));
        EXPECT_EQ(id_of(read_text(folder_ / "x")), "E-PART-DAMAGED");
    }
}

TEST_F(FilmState, PartsAreWholeWithAllTheirAreas) {
    FilmStateHead head;
    head.width = 3;
    head.height = 64;
    head.part = {1, 2};
    head.areas = areas_of_part(3, 64, head.part);
    EXPECT_TRUE(is_whole(head));
    head.areas.pop_back();
    EXPECT_FALSE(is_whole(head));
    EXPECT_EQ(areas_of_part(3, 64, {0, 1}), (std::vector<FilmArea>{{0, 0, 3, 64}}));
}

TEST_F(FilmState, HoldsSums) {
    FilmStateHead head;
    head.target_samples = 64;
    const std::vector<double> sums = {1, 2.5, 3};
    const auto put = [&](StateWriter& out) { out.put_array(sums); };
    ASSERT_TRUE(write_film_sums(folder_ / "sums", head, numbered_film(1), put));
    std::vector<double> read(3);
    std::vector<double> all;
    const auto take = [&](StateReader& in) { in.take_array(read); };
    const auto got = read_film_sums(folder_ / "sums", numbered_film(0), take);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->target_samples, 64);
    EXPECT_EQ(got->width, 3);
    EXPECT_EQ(read, sums);
    EXPECT_FALSE(is_whole(*got)) << "no part of a picture to be merged";
    const auto take_new = [&](StateReader& in) { in.take_new_array(all); };
    EXPECT_TRUE(read_film_sums(folder_ / "sums", numbered_film(0), take_new));
    EXPECT_EQ(all, sums);
    read.resize(2);
    EXPECT_FALSE(read_film_sums(folder_ / "sums", numbered_film(0), take));
    EXPECT_FALSE(read_film_sums(folder_ / "sums", numbered_film(0), [](StateReader&) {}));
    Film other = numbered_film(0);
    other.layers.clear();
    EXPECT_FALSE(read_film_sums(folder_ / "sums", other, take_new));
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
