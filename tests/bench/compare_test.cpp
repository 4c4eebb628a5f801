// tests/bench/compare_test.cpp - spreads, and telling a change from chance.
// SPDX-License-Identifier: Apache-2.0
#include "bench/compare.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <gmock/gmock.h>

namespace obscura::bench {
namespace {

using testing::HasSubstr;

TEST(Spread, OfNoneOneAndMany) {
    EXPECT_EQ(spread_of({}).median, 0);
    const Spread one = spread_of({3});
    EXPECT_EQ(one.low, 3);
    EXPECT_EQ(one.median, 3);
    EXPECT_EQ(one.high, 3);
    const Spread odd = spread_of({5, 1, 2});
    EXPECT_EQ(odd.low, 1);
    EXPECT_EQ(odd.median, 2);
    EXPECT_EQ(odd.high, 5);
    EXPECT_EQ(odd.relative(), 2);
    EXPECT_EQ(spread_of({4, 1, 2, 3}).median, 2.5);
}

TEST(Compare, TellsSecondsFromNoise) {
    const Spread before{1.00, 0.97, 1.03, 5};
    EXPECT_EQ(verdict({"a/render_s", before, {1.30, 1.25, 1.33, 5}}), "slower");
    EXPECT_EQ(verdict({"a/render_s", before, {0.70, 0.65, 0.75, 5}}), "faster");
    EXPECT_EQ(verdict({"a/render_s", before, {1.10, 1.02, 1.15, 5}}), "within noise")
        << "the ranges overlap";
    EXPECT_EQ(verdict({"a/render_s", {1, 1, 1, 5}, {1.015, 1.015, 1.015, 5}}), "within noise")
        << "machines drift by more than that";
}

TEST(Compare, NeedsThreeMeasurementsOfEach) {
    const Spread once = spread_of({1});
    const Spread slow = spread_of({4.6, 4.7, 4.8});
    EXPECT_EQ(verdict({"a/render_s", once, slow}), "too few measurements");
    EXPECT_EQ(verdict({"a/render_s", slow, once}), "too few measurements");
    EXPECT_EQ(verdict({"a/render_s", spread_of({1, 1, 1}), slow}), "slower");
}

TEST(Compare, MoreOfBareEmbreeIsFaster) {
    EXPECT_EQ(verdict({"a/of_bare", {0.5, 0.5, 0.5, 3}, {0.6, 0.6, 0.6, 3}}), "faster");
    EXPECT_EQ(verdict({"a/load_of_bare", {0.5, 0.5, 0.5, 3}, {0.4, 0.4, 0.4, 3}}), "slower");
}

TEST(Compare, BytesAreExact) {
    EXPECT_EQ(verdict({"a/bvh_bytes", {100, 100, 100}, {101, 101, 101}}), "larger");
    EXPECT_EQ(verdict({"a/bvh_bytes", {100, 100, 100}, {99, 99, 99}}), "smaller");
    EXPECT_EQ(verdict({"a/bvh_bytes", {100, 100, 100}, {100, 100, 100}}), "the same");
}

TEST(Compare, TakesWhatBothHave) {
    const std::vector<Figure> before = {{"a", {1, 1, 1}}, {"gone", {2, 2, 2}}};
    const std::vector<Figure> after = {{"new", {3, 3, 3}}, {"a", {4, 4, 4}}};
    const std::vector<Change> changes = compare(before, after);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].name, "a");
    EXPECT_EQ(changes[0].before.median, 1);
    EXPECT_EQ(changes[0].after.median, 4);
    EXPECT_THAT(compare_table(changes), HasSubstr("+300.0 %"));
}

TEST(Compare, RefusesWhatIsNoReport) {
    const TempFolder folder;
    const auto refused = [&](const std::filesystem::path& file) {
        const Result<OldReport> old = read_old_report(file);
        return !old && old.error().id == "E-BENCH-OLD" &&
               old.error().code == ExitCode::bad_resource;
    };
    EXPECT_TRUE(refused(folder / "missing.json"));
    EXPECT_TRUE(refused(folder.write("text.json", "no JSON")));
    EXPECT_TRUE(refused(folder.write("other.json", "{}")));
    EXPECT_TRUE(refused(folder.write("half.json", R"({"figures": [{"name": "a"}]})")));
    EXPECT_TRUE(refused(folder.write(
        "words.json", R"({"figures": [{"name": "a", "median": "b", "low": 1, "high": 2}]})")));
    EXPECT_TRUE(read_old_report(folder.write("empty.json", R"({"figures": []})")));
}

}  // namespace
}  // namespace obscura::bench
