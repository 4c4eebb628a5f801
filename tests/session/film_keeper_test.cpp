// tests/session/film_keeper_test.cpp - checkpoints: what is finished, two generations, what fits.
// SPDX-License-Identifier: Apache-2.0
#include "session/film_keeper.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include "support/text_files.h"
#include <cmath>

namespace obscura {
namespace {

/// A film of 4 x 4 pixels that was rendered as a crop at 10, 20.
Film small_film() {
    Film film;
    film.width = 4;
    film.height = 4;
    film.channels = {"R"};
    film.part_of = ImagePart{100, 100, 10, 20};
    film.pixels.assign(16, 0.5f);
    return film;
}

FilmStateHead head_of(const std::string& seed) {
    FilmStateHead head;
    head.options = {{"--seed", seed}};
    return head;
}

class FilmKeeping : public testing::Test {
protected:
    FilmKeeper keeper(const std::string& seed = "1") const {
        return {head_of(seed), folder_ / "a.checkpoint"};
    }
    /// A finished row of the film.
    static FinishedTile row(const Film& film, int y) {
        FinishedTile out{0, {10, 20 + y, 4, 1}, &film};
        out.counters.paths = 7;
        return out;
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

    Log log_;
    TempFolder folder_;
};

TEST_F(FilmKeeping, GoesOnFromTheNewestGeneration) {
    Film film = small_film();
    FilmKeeper first = keeper();
    ASSERT_TRUE(first.fill(film));
    EXPECT_EQ(first.fraction(), 0);
    for (int y = 0; y < 3; ++y) {
        first.add(row(film, y));
        ASSERT_TRUE(first.save_meanwhile());
    }
    first.leave();
    EXPECT_EQ(first.fraction(), 0.75);
    EXPECT_TRUE(exists("a.checkpoint.1"));

    FilmKeeper second = keeper();
    ASSERT_TRUE(second.find(Resume::automatic, log_));
    Film next = small_film();
    next.pixels.assign(16, 9.0f);
    const auto areas = second.fill(next);
    ASSERT_TRUE(areas);
    EXPECT_EQ(pixels_in(*areas), 12);
    EXPECT_EQ(next.pixels[11], 0.5f);
    EXPECT_EQ(next.pixels[12], 9.0f);
    EXPECT_EQ(second.resumed_counters().paths, 21u);

    const std::string newest = read_text(folder_ / "a.checkpoint");
    folder_.write("a.checkpoint", newest.substr(1));
    FilmKeeper third = keeper();
    ASSERT_TRUE(third.find(Resume::require, log_));
    EXPECT_EQ(log_.warnings().size(), 1u);
    EXPECT_EQ(pixels_in(*third.fill(next)), 8);
    third.remove();
    EXPECT_FALSE(exists("a.checkpoint") || exists("a.checkpoint.1"));
}

TEST_F(FilmKeeping, ADamagedCheckpointNeverTakesThePlaceOfAWholeOne) {
    Film film = small_film();
    FilmKeeper first = keeper();
    ASSERT_TRUE(first.fill(film));
    first.add(row(film, 0));
    ASSERT_TRUE(first.save(film));
    std::filesystem::rename(folder_ / "a.checkpoint", folder_ / "a.checkpoint.1");
    const std::string whole = read_text(folder_ / "a.checkpoint.1");
    folder_.write("a.checkpoint", "OBSFILM3 and so on");
    FilmKeeper second = keeper();
    ASSERT_TRUE(second.find(Resume::automatic, log_));
    ASSERT_TRUE(second.fill(film));
    second.add(row(film, 1));
    ASSERT_TRUE(second.save(film));
    EXPECT_EQ(read_text(folder_ / "a.checkpoint.1"), whole);
}

TEST_F(FilmKeeping, RefusesWhatDoesNotFit) {
    EXPECT_TRUE(keeper().find(Resume::automatic, log_));
    const Result<void> none = keeper().find(Resume::require, log_);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().id, "E-RESUME-NONE");
    EXPECT_EQ(none.error().code, ExitCode::io_error);
    Film film = small_film();
    FilmKeeper first = keeper();
    ASSERT_TRUE(first.fill(film));
    first.add(row(film, 0));
    ASSERT_TRUE(first.save(film));
    const Result<void> other = keeper("2").find(Resume::automatic, log_);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().id, "E-RESUME-MIX");
    EXPECT_EQ(other.error().code, ExitCode::configuration);
    EXPECT_NE(other.error().message.find("--seed: 1 and 2"), std::string::npos);
    EXPECT_TRUE(exists("a.checkpoint"));
    EXPECT_TRUE(keeper("2").find(Resume::never, log_));
    EXPECT_FALSE(exists("a.checkpoint"));
}

TEST_F(FilmKeeping, MoreSamplesGoOnWhereTheFirstOnesAreTheSame) {
    const auto keeper_of = [&](int samples, const std::string& seed = "1") {
        FilmStateHead head = head_of(seed);
        head.options.emplace_back("--spp", std::to_string(samples));
        head.target_samples = samples;
        return FilmKeeper(head, folder_ / "a.checkpoint");
    };
    const auto leave = [&](int samples) {
        FilmStateHead head = head_of("1");
        head.options.emplace_back("--spp", std::to_string(samples));
        head.target_samples = samples;
        const auto put = [](StateWriter& out) { out.put_number(1); };
        ASSERT_TRUE(write_film_sums(folder_ / "a.checkpoint", head, small_film(), put));
    };
    leave(64);
    EXPECT_TRUE(keeper_of(64).find(Resume::require, log_));
    EXPECT_TRUE(keeper_of(1000).find(Resume::require, log_));
    EXPECT_FALSE(keeper_of(1000, "2").find(Resume::require, log_));
    EXPECT_FALSE(keeper_of(63).find(Resume::require, log_));
    leave(32);
    EXPECT_TRUE(keeper_of(32).find(Resume::require, log_));
    const Result<void> few = keeper_of(64).find(Resume::require, log_);
    ASSERT_FALSE(few);
    EXPECT_NE(few.error().message.find("--spp: 32 and 64"), std::string::npos);
}

TEST_F(FilmKeeping, MoreSamplesAreOthersWhereTheirNoiseDecides) {
    const auto head_with = [&](int samples) {
        FilmStateHead head = head_of("1");
        head.options.emplace_back("--spp", std::to_string(samples));
        head.target_samples = samples;
        head.is_adaptive = true;
        return head;
    };
    const auto put = [](StateWriter& out) { out.put_number(1); };
    ASSERT_TRUE(write_film_sums(folder_ / "a.checkpoint", head_with(64), small_film(), put));
    EXPECT_TRUE(FilmKeeper(head_with(64), folder_ / "a.checkpoint").find(Resume::require, log_));
    EXPECT_FALSE(FilmKeeper(head_with(128), folder_ / "a.checkpoint").find(Resume::require, log_));
}

TEST_F(FilmKeeping, TellsWhatTheLatestCheckpointHolds) {
    Film film = small_film();
    FilmKeeper first = keeper();
    ASSERT_TRUE(first.fill(film));
    EXPECT_EQ(first.saved_fraction(), 0);
    EXPECT_TRUE(std::isinf(first.seconds_since_save()));
    first.add(row(film, 0));
    ASSERT_TRUE(first.save(film));
    const double saved = first.fraction();
    first.add(row(film, 1));
    EXPECT_GT(first.fraction(), saved);
    EXPECT_EQ(first.saved_fraction(), saved);
    EXPECT_FALSE(std::isinf(first.seconds_since_save()));
    FilmKeeper second = keeper();
    ASSERT_TRUE(second.find(Resume::require, log_));
    ASSERT_TRUE(second.fill(film));
    EXPECT_EQ(second.saved_fraction(), saved);
    EXPECT_TRUE(std::isinf(second.seconds_since_save())) << "it was written by another";
}

TEST_F(FilmKeeping, TellsAndShowsWhatIsFinished) {
    Film film = small_film();
    FilmKeeper keeping(FilmStateHead(), std::nullopt);
    EXPECT_FALSE(keeping.film_so_far());
    ASSERT_TRUE(keeping.fill(film));
    keeping.add(row(film, 1));
    const std::optional<Film> shown = keeping.film_so_far();
    ASSERT_TRUE(shown);
    EXPECT_EQ(shown->pixels[3], 0);
    EXPECT_EQ(shown->pixels[4], 0.5f);
    EXPECT_EQ(keeping.fraction(), 0.25);
    keeping.leave();
    EXPECT_FALSE(keeping.film_so_far());
    ASSERT_TRUE(keeping.save(film));
    EXPECT_EQ(keeping.file_if_kept(), "");
    EXPECT_EQ(folder_.file_count(), 0u);
}

}  // namespace
}  // namespace obscura
