// tests/app/reports_test.cpp - numbers of the reports; whole documents are in tests/cli.
// SPDX-License-Identifier: Apache-2.0
#include "app/info_report.h"
#include "session/statistics.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::app {
namespace {

using testing::HasSubstr;

TEST(Statistics, MoreThanOneInAMillionIsTooMany) {
    RenderCounters counters;
    EXPECT_FALSE(too_many_nonfinite(counters));
    counters.paths = 3'000'000;
    counters.nonfinite_samples = 3;
    EXPECT_FALSE(too_many_nonfinite(counters));
    counters.nonfinite_samples = 4;
    EXPECT_TRUE(too_many_nonfinite(counters));
    counters.paths = 999'999;
    counters.nonfinite_samples = 1;
    EXPECT_TRUE(too_many_nonfinite(counters)) << "a single one in a small picture";
    counters.nonfinite_samples = 0;
    EXPECT_FALSE(too_many_nonfinite(counters));
}

TEST(Statistics, RatesComeFromTheRenderTimeAlone) {
    RenderRequest request;
    request.scene = "s.glb";
    RenderStatistics statistics;
    statistics.render_s = 2;
    statistics.total_s = 50;
    statistics.counters = {10, 10, 20, 30, 1, 2, {}};
    EXPECT_EQ(total_rays(statistics.counters), 60U);
    const std::string json = statistics_json(request, statistics);
    EXPECT_THAT(json, HasSubstr("\"rays_per_second\": 30.0,"));
    EXPECT_THAT(json, HasSubstr("\"paths_per_second\": 5.0,"));
    EXPECT_THAT(json, HasSubstr("\"refused_rays\": 1,"));
    EXPECT_THAT(json, HasSubstr("\"nonfinite_samples\": 2\n"));
    statistics.render_s = 0;
    EXPECT_THAT(statistics_json(request, statistics), HasSubstr("\"rays_per_second\": 0.0,"));
}

TEST(Statistics, AovsTakeOneSample) {
    RenderRequest request;
    request.options.integrator = Integrator::depth;
    EXPECT_THAT(statistics_json(request, {}), HasSubstr("\"spp\": 1,"));
    EXPECT_THAT(statistics_json(request, {}), HasSubstr("\"integrator\": \"depth\""));
}

TEST(InfoReport, TexturesCountOnceForEachUse) {
    ImageInfo image;
    image.width = 4;
    image.height = 2;
    EXPECT_EQ(texture_bytes(image), 0U) << "not used";
    image.used_as_color = true;
    EXPECT_EQ(texture_bytes(image), (8U + 2U + 1U) * 4U);
    image.used_as_data = true;
    EXPECT_EQ(texture_bytes(image), (8U + 2U + 1U) * 8U);
}

TEST(InfoReport, NamesFromTheFileAreEscaped) {
    Scene scene;
    scene.material_names = {"default material", "evil\x1b[31m\nname", "evil\x1b[31m\nname"};
    scene.material_numbers = {-1, 0, 0};
    scene.info.file_name = "a\tb";
    scene.info.extensions = {{"EXT_x", true, false, {"evil\x07"}}};
    const std::string table = info_table(scene);
    EXPECT_THAT(table, HasSubstr("'evil\\x1b[31m\\x0aname'"));
    EXPECT_THAT(table, HasSubstr("a\\x09b"));
    EXPECT_THAT(table, HasSubstr("EXT_x: ignored, required\n         material 'evil\\x07'"));
    EXPECT_THAT(info_json(scene, {"w\x01"}), HasSubstr("evil\\u001b[31m\\nname"));
}

}  // namespace
}  // namespace obscura::app
