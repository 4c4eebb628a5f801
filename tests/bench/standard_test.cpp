// tests/bench/standard_test.cpp - the standard's scenes are the same everywhere; its arithmetic.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json.h"
#include "base/parallel.h"
#include "bench/measure_standard.h"
#include "bench/standard_report.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <gmock/gmock.h>
#include <set>

namespace obscura::bench {
namespace {

using testing::HasSubstr;

RenderOptions small_options() {
    RenderOptions out;
    out.width = 48;
    out.height = 27;
    out.samples_per_pixel = 4;
    out.max_bounces = standard_depth;
    return out;
}

UnsetArray<float> pixels_of(const StandardScene& scene, int threads, int tile_size) {
    const ThreadLimit limit(threads);
    Log log(Verbosity::quiet);
    const auto prepared = PreparedScene::create(scene.make(), scene.light(), Isa::automatic, log);
    EXPECT_TRUE(prepared);
    RenderOptions options = small_options();
    options.tile_size = tile_size;
    const Camera camera = camera_of(scene, options.width, options.height);
    const std::atomic<bool> stop = false;
    auto result = render(*prepared, camera, options, {}, stop);
    EXPECT_TRUE(result);
    EXPECT_EQ(result->counters.nonfinite_samples, 0U) << scene.name;
    return std::move(result->film.pixels);
}

TEST(Standard, ScenesGiveTheSameBitsOnAnyThreads) {
    for (const StandardScene& scene : standard_scenes()) {
        const UnsetArray<float> one = pixels_of(scene, 1, 16);
        EXPECT_EQ(pixels_of(scene, 3, 32), one) << scene.name;
        double sum = 0;
        for (size_t i = 0; i < one.size(); ++i)
            sum += i % 4 == 3 ? 0 : one[i];
        const double mean = sum / static_cast<double>(one.size() / 4 * 3);
        EXPECT_NEAR(mean / scene.mean, 1, 0.1) << scene.name << " at few samples";
    }
}

TEST(Standard, ScenesAreWhatTheySay) {
    std::set<std::string> names;
    for (const StandardScene& scene : standard_scenes()) {
        EXPECT_TRUE(names.insert(scene.name).second);
        const Scene made = scene.make();
        EXPECT_FALSE(made.bounds.empty());
        EXPECT_GT(scene.noise, 0);
    }
    const Scene landscape = standard_scenes()[0].make();
    EXPECT_EQ(landscape.instances.size(), 2000U);
    EXPECT_EQ(landscape.primitives[0].triangle_count, 2 * 512 * 512);
    const Scene samples = standard_scenes()[1].make();
    EXPECT_EQ(samples.primitives.size(), 16U);
    EXPECT_EQ(samples.textures.records.size(), 3U);
    const Scene hall = standard_scenes()[2].make();
    EXPECT_EQ(hall.lights.size(), 40U);
}

/// Two pictures of two pixels: (1, 1, 1) and (3, 3, 3); (2, 2, 2) twice.
TEST(Standard, NoiseIsTheVarianceOverTheSquaredMean) {
    NoiseOfRenderings noise;
    const std::vector<float> a = {1, 1, 1, 0.5f, 2, 2, 2, 0.5f};
    const std::vector<float> b = {3, 3, 3, 0.5f, 2, 2, 2, 0.5f};
    noise.add(a, 4);
    noise.add(b, 4);
    EXPECT_DOUBLE_EQ(noise.mean(), 2);
    // Three variances of 2 over three squares of 4 and a hundredth of 6 * 6; none in the second.
    EXPECT_NEAR(noise.relative_error(), 0.5 * 6 / (12 + 0.36), 1e-12);
}

/// 2000 pixels, of which the two noisiest are left out.
TEST(Standard, FirefliesDoNotCount) {
    std::vector<float> quiet(3 * 2000, 1.0f);
    std::vector<float> specks = quiet;
    specks[0] = specks[300] = 1e4f;
    NoiseOfRenderings noise;
    noise.add(quiet, 3);
    noise.add(specks, 3);
    EXPECT_EQ(noise.relative_error(), 0);
}

TEST(Standard, TheMeanOfScoresIsGeometric) {
    EXPECT_DOUBLE_EQ(geometric_mean(std::vector<double>{2, 4, 1}), 2);
    EXPECT_DOUBLE_EQ(geometric_mean(std::vector<double>{5}), 5);
}

/// Ranks by the sign test: of 8 values 1 and 8, of 16 values 4 and 13 (Conover, table A.3, +-1).
TEST(Standard, MoreRoundsMakeTheMedianMoreCertain) {
    std::vector<double> values;
    for (int i = 1; i <= 8; ++i)
        values.push_back(100 + i);
    EXPECT_NEAR(spread_of_median(values), 7 / 104.5, 1e-12);
    for (int i = 9; i <= 16; ++i)
        values.push_back(100 + i);
    EXPECT_NEAR(spread_of_median(values), 9 / 108.5, 1e-12);
    std::vector<double> disturbed(32, 100.0);
    disturbed[5] = disturbed[17] = disturbed[30] = 40;
    EXPECT_EQ(spread_of_median(disturbed), 0);
    EXPECT_EQ(spread_of_median({1}), 1);
}

/// Two scenes of a million samples.
StandardReport report_of_two() {
    StandardReport out;
    out.width = 1000;
    out.height = 100;
    out.samples_per_pixel = 10;
    StandardFigures a;
    a.name = "a";
    a.noise = 0.02;
    a.relative_error = 0.01;
    a.expected_mean = a.mean = 1;
    a.seconds = {0.5, 0.5, 0.5};
    StandardFigures b = a;
    b.name = "b";
    b.relative_error = 0.02;
    b.seconds = {0.25, 0.25, 1};
    out.scenes = {a, b};
    finish(out);
    return out;
}

TEST(Standard, TheScoreIsSamplesASecondAtFixedNoise) {
    const StandardReport report = report_of_two();
    ASSERT_EQ(report.rounds.size(), 3U);
    // a: 2 M/s, and half as many samples are enough; b: 4 M/s, in the last round 1.
    EXPECT_NEAR(report.rounds[0], 4, 1e-12);
    EXPECT_NEAR(report.rounds[2], 2, 1e-12);
    EXPECT_NEAR(report.score, 4, 1e-12);
    EXPECT_NEAR(report.spread, 0.5, 1e-12);
    EXPECT_FALSE(report.is_steady);
    EXPECT_NEAR(report.scenes[1].samples_per_second, 4e6, 1e-3);
    EXPECT_THAT(standard_table(report), HasSubstr("not to be published"));
    ASSERT_EQ(doubts_about(report).size(), 1U);
    EXPECT_THAT(doubts_about(report)[0], HasSubstr("uncertain by 50.0 %"));
}

TEST(Standard, AnotherImageIsDoubted) {
    StandardReport report = report_of_two();
    report.scenes[0].mean = 1.02;
    report.is_steady = true;
    ASSERT_EQ(doubts_about(report).size(), 1U);
    EXPECT_THAT(doubts_about(report)[0], HasSubstr("a: the picture is +2.0 % brighter"));
}

TEST(Standard, TheJsonHasWhatIsPublished) {
    const Json json = Json::parse(standard_json(report_of_two(), {}));
    EXPECT_EQ(json.at("standard"), standard_version);
    for (const char* key : {"score",
                            "spread",
                            "steady",
                            "rounds",
                            "version",
                            "isa",
                            "threads",
                            "circumstances",
                            "machine",
                            "settings",
                            "figures",
                            "changes",
                            "warnings"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key : {"cpu", "cores", "clock_mhz", "caches", "numa_nodes", "load"})
        EXPECT_TRUE(json.at("machine").contains(key)) << key;
    ASSERT_EQ(json.at("scenes").size(), 2U);
    const Json& scene = json.at("scenes").at(0);
    EXPECT_EQ(scene.at("name"), "a");
    EXPECT_NEAR(scene.at("samples_for_noise").get<double>(), 5, 1e-12);
    EXPECT_NEAR(scene.at("samples_per_second_at_noise").get<double>(), 4e6, 1e-3);
    EXPECT_TRUE(json.at("changes").empty());
}

/// --compare reads what --json wrote.
TEST(Standard, ReportsAreComparedByScoreAndScene) {
    TempFolder folder;
    const StandardReport report = report_of_two();
    folder.write("old.json", standard_json(report, {}));
    const Result<OldReport> old = read_old_report(folder / "old.json");
    ASSERT_TRUE(old) << old.error().message;
    EXPECT_EQ(old->standard, standard_version);
    EXPECT_EQ(old->circumstances, circumstances_of(report));
    StandardReport faster = report;
    for (StandardFigures& scene : faster.scenes) {
        for (double& seconds : scene.seconds)
            seconds *= 0.1;
    }
    finish(faster);
    const std::vector<Change> changes = compare(old->figures, comparable_figures(faster));
    ASSERT_EQ(changes.size(), 3U);
    for (const Change& change : changes)
        EXPECT_EQ(verdict(change), "faster") << change.name;
}

/// All of it, small: as many rounds as allowed, the figures of every scene filled in.
TEST(Standard, IsMeasuredInRounds) {
    StandardTask task;
    task.width = 16;
    task.height = 9;
    task.samples_per_pixel = 2;
    task.min_rounds = 2;
    task.max_rounds = 3;
    task.threads = 1;
    Log log(Verbosity::quiet);
    const std::atomic<bool> stop = false;
    const Result<StandardReport> report = measure_standard(task, stop, log);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_THAT(report->rounds.size(), testing::AllOf(testing::Ge(2U), testing::Le(3U)));
    ASSERT_EQ(report->scenes.size(), 3U);
    for (const StandardFigures& scene : report->scenes) {
        EXPECT_GT(scene.relative_error, 0) << scene.name;
        EXPECT_GT(scene.mean, 0) << scene.name;
        EXPECT_EQ(scene.seconds.size(), report->rounds.size());
    }
    EXPECT_EQ(report->scenes[0].triangles, 2U * 512 * 512 + 2000U * 20448);
    EXPECT_FALSE(report->isa.empty());
    const std::atomic<bool> stopped = true;
    const Result<StandardReport> none = measure_standard(task, stopped, log);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().id, "E-STOPPED");
}

}  // namespace
}  // namespace obscura::bench
