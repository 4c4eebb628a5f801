// tests/crosscheck/wrong_formula_test.cpp - cross-checks must fail loudly when a kernel is wrong.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/budget.h"
#include "crosscheck/check_scenes.h"
#include "crosscheck/ray_set.h"

#include <gtest/gtest.h>

namespace obscura::crosscheck {
namespace {

using namespace test;

constexpr uint64_t ray_count = 9216;  // each group of rays once

/// Verdicts on a kernel that is right except for `spoil`.
template <typename Spoil>
CheckedScene check_spoilt(const Scene& scene, const Spoil& spoil) {
    const TrueScene truth(scene);
    const RaySet rays(truth, few_rays(ray_count));
    AnswerList truths;
    compare_kernel(truth, batches_of(rays)[0], truth_kernel(truth), {}, {.answers = &truths});
    truths.is_truth = true;
    const Kernel spoilt{"spoilt", [&](RayBlock& block, std::vector<Answer>& answers) {
                            truth_kernel(truth).ask(block, answers);
                            for (Answer& answer : answers)
                                spoil(answer);
                        }};
    CheckedScene checked;
    checked.pairs = compare_kernel(truth, batches_of(rays)[0], spoilt, {&truths}, {});
    checked.faults = faults_of(checked);
    return checked;
}

TEST(WrongFormula, TheTruthItselfIsWithinTheBudget) {
    const CheckedScene checked = check_spoilt(closed_cube(), [](Answer&) {});
    EXPECT_TRUE(checked.faults.empty());
    EXPECT_EQ(checked.pairs.at(0).total().rays, ray_count);
    EXPECT_GT(checked.pairs.at(0).total().hits, ray_count / 4);
}

TEST(WrongFormula, DepthOffByAHundredThousandthIsAFault) {
    const CheckedScene checked =
        check_spoilt(closed_cube(), [](Answer& answer) { answer.t *= 1.00001; });
    ASSERT_FALSE(checked.faults.empty());
    EXPECT_NE(checked.faults[0].find("4 ulp do not explain"), std::string::npos);
    EXPECT_GT(checked.pairs.at(0).total().of(Verdict::depth), 0U);
}

TEST(WrongFormula, AMissingTriangleIsAFault) {
    const CheckedScene checked = check_spoilt(closed_cube(), [](Answer& answer) {
        if (answer.item.element == 7) answer = {};
    });
    EXPECT_FALSE(checked.faults.empty());
    EXPECT_GT(checked.pairs.at(0).total().of(Verdict::missed), 0U);
}

TEST(WrongFormula, ASphereOfTheWrongSizeIsAFault) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    Scene larger = empty_scene({});
    add_shape(larger, make_shape(ShapeKind::sphere, 1.0001F), 0);
    const TrueScene truth(scene);
    const TrueScene wrong(larger);
    const RaySet rays(truth, few_rays(ray_count / 4));
    AnswerList truths;
    compare_kernel(truth, batches_of(rays)[0], truth_kernel(truth), {}, {.answers = &truths});
    truths.is_truth = true;
    CheckedScene checked;
    checked.pairs = compare_kernel(truth, batches_of(rays)[0], truth_kernel(wrong), {&truths}, {});
    EXPECT_GT(checked.pairs.at(0).total().of(Verdict::depth), 0U);
    EXPECT_FALSE(faults_of(checked).empty());
}

TEST(WrongFormula, TheWorstDifferencesCanBeReplayed) {
    const CheckedScene checked = check_spoilt(closed_cube(), [](Answer& answer) {
        if (answer.item.element == 7) answer = {};
    });
    const PairFigures& pair = checked.pairs.at(0);
    ASSERT_EQ(pair.worst.size(), max_worst);
    const Scene cube = closed_cube();
    const TrueScene truth(cube);
    for (const Difference& difference : pair.worst)
        EXPECT_EQ(truth.nearest(difference.ray).item.element, 7);
}

TEST(RayBatches, HoldEveryRayOnceAndNoMoreThanMemoryAllows) {
    const Scene cube = closed_cube();
    const TrueScene truth(cube);
    const RaySet rays(truth, few_rays(100000001));
    uint64_t next = 0;
    for (const RayBatch& batch : batches_of(rays)) {
        EXPECT_EQ(batch.first_ray(), next);
        EXPECT_LE(batch.count(), 1U << 22U);
        next += batch.count();
    }
    EXPECT_EQ(next, rays.count());
}

TEST(RayBatches, TogetherSayWhatOneDoes) {
    const Scene cube = closed_cube();
    const TrueScene truth(cube);
    const RaySet rays(truth, few_rays(2 * ray_count - 100));
    const Kernel blind{"blind", [&](RayBlock& block, std::vector<Answer>& answers) {
                           truth_kernel(truth).ask(block, answers);
                           for (size_t i = 0; i < answers.size(); i += 100)
                               answers[i] = {};
                       }};
    const auto figures = [&](const RayBatch& batch) {
        AnswerList truths;
        compare_kernel(truth, batch, truth_kernel(truth), {}, {.answers = &truths});
        return compare_kernel(truth, batch, blind, {&truths}, {})[0];
    };
    const PairFigures whole = figures(batches_of(rays)[0]);
    PairFigures parts = figures({rays, 0, 5});
    parts.add(figures({rays, 5, rays.chunks() - 5}));
    EXPECT_GT(whole.total().of(Verdict::missed), 0U);
    EXPECT_EQ(parts.total().rays, rays.count());
    EXPECT_EQ(parts.total().counts, whole.total().counts);
    ASSERT_EQ(parts.worst.size(), whole.worst.size());
    for (size_t i = 0; i < whole.worst.size(); ++i)
        EXPECT_EQ(parts.worst[i].number, whole.worst[i].number);
}

/// Answers that have been compared before count again, and others to the same rays do not.
TEST(WrongFormula, SaysTheSameOfASecondKernelWithTheSameAnswers) {
    const Scene cube = closed_cube();
    const TrueScene truth(cube);
    const RaySet rays(truth, few_rays(ray_count));
    const RayBatch batch = batches_of(rays)[0];
    AnswerList truths;
    compare_kernel(truth, batch, truth_kernel(truth), {}, {.answers = &truths});
    const auto off_by = [&](double factor) {
        const Kernel kernel{"off", [&truth, factor](RayBlock& block, std::vector<Answer>& answers) {
                                truth_kernel(truth).ask(block, answers);
                                for (Answer& answer : answers)
                                    answer.t *= factor;
                            }};
        return compare_kernel(truth, batch, kernel, {&truths}, {})[0];
    };
    const PairFigures first = off_by(1.00001);
    const PairFigures right = off_by(1);
    const PairFigures again = off_by(1.00001);
    EXPECT_GT(first.total().of(Verdict::depth), 0U);
    EXPECT_EQ(right.total().of(Verdict::agree), ray_count);
    EXPECT_EQ(again.total().counts, first.total().counts);
    ASSERT_EQ(again.worst.size(), first.worst.size());
    for (size_t i = 0; i < first.worst.size(); ++i)
        EXPECT_EQ(again.worst[i].comparison.ulps, first.worst[i].comparison.ulps);
}

TEST(WrongFormula, LeaksSelfHitsAndWallsAreFaults) {
    CheckedScene checked;
    EXPECT_TRUE(faults_of(checked).empty());
    checked.spawned.self_hits = 1;
    checked.spawned.wall_leaks = 1;
    checked.formulas.wrong = 1;
    checked.truth.wrong = 1;
    LeakFigures leaky{"obscura", true, {}, {}};
    leaky.by_aim[0] = {100, 1};
    LeakFigures at_vertices{"robust 1", true, {}, {}};
    at_vertices.by_aim[2] = {100, 50};
    checked.leaks.kernels = {leaky, at_vertices};
    EXPECT_EQ(faults_of(checked).size(), 5U);
}

TEST(Budget, AllowsWhatChanceMakesOfAMillionth) {
    EXPECT_EQ(mismatches_allowed(1000), 0U);     // e^-0.001 is 0.999
    EXPECT_EQ(mismatches_allowed(1000000), 5U);  // Poisson of mean 1: 0.9994 at most 5
    EXPECT_GT(mismatches_allowed(1000000000), 1000U);
    EXPECT_LT(mismatches_allowed(1000000000), 1110U);
}

}  // namespace
}  // namespace obscura::crosscheck
