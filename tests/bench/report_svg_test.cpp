// tests/bench/report_svg_test.cpp - the chart is well-formed and shows what was measured.
// SPDX-License-Identifier: Apache-2.0
#include "bench/report_svg.h"

#include <gtest/gtest.h>

#include "support/xml_text.h"
#include <gmock/gmock.h>

namespace obscura::bench {
namespace {

using test::is_well_formed;
using testing::HasSubstr;
using testing::Not;

ViewFigures row(const std::string& isa, int threads, double seconds) {
    ViewFigures out;
    out.name = "whole";
    out.isa = isa;
    out.threads = threads;
    out.render_s = {seconds, seconds, seconds};
    return out;
}

BenchReport some_report() {
    BenchReport report;
    report.machine.cpu = "A <fast> & \"odd\" CPU";
    SceneFigures scene;
    scene.name = "box & ball";
    scene.by_threads = {row("avx2", 1, 4), row("avx2", 2, 2), row("avx2", 4, 1.25)};
    scene.by_isa = {row("avx512", 4, 1), row("baseline", 4, 3)};
    report.scenes = {scene, scene};
    report.scenes[1].name = "other";
    return report;
}

TEST(BenchSvg, IsWellFormed) {
    const std::string svg = bench_svg(some_report());
    EXPECT_TRUE(is_well_formed(svg)) << svg;
    EXPECT_FALSE(is_well_formed("<svg><a></svg>"));
    EXPECT_FALSE(is_well_formed("<svg>A & B</svg>"));
}

TEST(BenchSvg, ShowsBothPanelsOrOne) {
    BenchReport report = some_report();
    const std::string both = bench_svg(report);
    EXPECT_THAT(both, HasSubstr("Speed-up by threads"));
    EXPECT_THAT(both, HasSubstr("Speed-up by instruction set"));
    EXPECT_THAT(both, HasSubstr("box &amp; ball, whole"));
    EXPECT_THAT(both, HasSubstr("A &lt;fast&gt; &amp; &quot;odd&quot; CPU"));
    for (SceneFigures& scene : report.scenes)
        scene.by_isa.clear();
    const std::string one = bench_svg(report);
    EXPECT_TRUE(is_well_formed(one));
    EXPECT_THAT(one, Not(HasSubstr("instruction set")));
}

TEST(Report, SpeedUpsAreRelativeToTheRightRow) {
    const SceneFigures scene = some_report().scenes[0];
    const ViewFigures& one = fewest_threads(scene, scene.by_threads[2]);
    EXPECT_EQ(one.threads, 1);
    EXPECT_DOUBLE_EQ(speedup_over(one, scene.by_threads[1]), 2);
    EXPECT_DOUBLE_EQ(parallel_efficiency(one, scene.by_threads[2]), 0.8);
    ASSERT_NE(baseline_row(scene, scene.by_isa[0]), nullptr);
    EXPECT_DOUBLE_EQ(speedup_over(*baseline_row(scene, scene.by_isa[0]), scene.by_isa[0]), 3);
}

}  // namespace
}  // namespace obscura::bench
