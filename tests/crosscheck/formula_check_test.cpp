// tests/crosscheck/formula_check_test.cpp - sides of shapes by hand, and formulas against them.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/formula_check.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/shape_side.h"

#include <gtest/gtest.h>

namespace obscura::crosscheck {
namespace {

using namespace test;

TEST(FormulaCheck, SidesOfShapes) {
    EXPECT_DOUBLE_EQ(side_of_shape(make_shape(ShapeKind::sphere, 2), {0, 3, 0}), 1);
    EXPECT_DOUBLE_EQ(side_of_shape(make_shape(ShapeKind::box, 1, 2, 3), {0.5, 0, 0}), -0.5);
    const ShapeRecord cone = make_shape(ShapeKind::frustum, 1, 2, 0);
    EXPECT_DOUBLE_EQ(side_of_shape(cone, {0.75, 0, 0}), -0.25);
    EXPECT_DOUBLE_EQ(side_of_shape(cone, {0, 1.5, 0}), 0.5);
    // Equal spheres: a cylinder between them.
    const ShapeRecord capsule = make_shape(ShapeKind::capsule, 1, 0.5F, 0.5F);
    EXPECT_NEAR(side_of_shape(capsule, {0.7, 0.3, 0}), 0.2, 1e-9);
    EXPECT_NEAR(side_of_shape(capsule, {0, 2, 0}), 0.5, 1e-9);
    ShapeRecord saddle = make_shape(ShapeKind::quadric, 1, 1, 1);
    saddle.k[0] = 1;
    saddle.k[2] = -1;
    saddle.k[7] = -2;
    EXPECT_DOUBLE_EQ(side_of_shape(saddle, {0.5, 0.25, 0.5}), -0.5);
}

/// One of each kind, moved away from the origin.
std::vector<ShapeRecord> one_of_each() {
    std::vector<ShapeRecord> records = {make_shape(ShapeKind::sphere, 0.7F),
                                        make_shape(ShapeKind::box, 0.5F, 1, 2),
                                        make_shape(ShapeKind::frustum, 1, 0.5F, 0.2F),
                                        make_shape(ShapeKind::frustum, 1, 0.5F, 0),
                                        make_shape(ShapeKind::capsule, 0.6F, 0.5F, 0.3F),
                                        make_shape(ShapeKind::plane, 2, 1),
                                        make_shape(ShapeKind::plane, unbounded, unbounded),
                                        make_shape(ShapeKind::disk, 1, 0.3F),
                                        make_shape(ShapeKind::quadric, 1, 1, 1)};
    records.back().k[0] = 1;
    records.back().k[1] = -0.8F;
    records.back().k[2] = 1.5F;
    records.back().k[9] = -0.1F;
    for (ShapeRecord& record : records)
        record.centre[0] = 0.25F;
    return records;
}

TEST(FormulaCheck, EveryShapeIsRight) {
    for (const ShapeRecord& record : one_of_each()) {
        Scene scene = empty_scene({});
        add_shape(scene, record, 0);
        const TrueScene truth(scene);
        const FormulaCheck check = check_formulas(truth, 20000, 1);
        EXPECT_EQ(check.wrong, 0U) << "kind " << record.kind;
        EXPECT_EQ(check.wrong_truth, 0U) << "kind " << record.kind;
        EXPECT_EQ(check.segments, 20000U);
    }
}

TEST(FormulaCheck, TrianglesAreRight) {
    const Scene scene = closed_cube();
    EXPECT_EQ(check_formulas(TrueScene(scene), 20000, 1), (FormulaCheck{20000, 0, 0}));
}

TEST(FormulaCheck, TrianglesWithoutAreaHaveNothingToBeWrongAbout) {
    Scene scene = closed_cube();
    for (size_t i = 0; i < 9; ++i)
        scene.indices[i] = static_cast<uint32_t>(i < 3 ? 0 : i < 6 ? i % 2 : 5);
    pad_tables(scene);
    EXPECT_EQ(check_formulas(TrueScene(scene), 20000, 1), (FormulaCheck{20000, 0, 0}));
}

/// Quadrics of which many lines have no quadratic and no linear term.
std::vector<ShapeRecord> ruled_quadrics() {
    const float coefficients[][10] = {{1, 1, 0, 0, 0, 0, 0, 0, 0, -0.09F},
                                      {1, 0, 0, 0, 0, 0, 0, -1, 0, 0},
                                      {1, -1, 0, 0, 0, 0, 0, 0, 0, -0.04F},
                                      {1, 0, -1, 0, 0, 0, 0, -1, 0, 0},
                                      {1, -1, 1, 0, 0, 0, 0, 0, 0, 0},
                                      {0, 0, 0, 0, 0, 0, 0.3F, 0.5F, -0.7F, 0.1F}};
    std::vector<ShapeRecord> records;
    for (const auto& k : coefficients) {
        records.push_back(make_shape(ShapeKind::quadric, 0.5F, 0.6F, 0.55F));
        std::copy(std::begin(k), std::end(k), std::begin(records.back().k));
        records.back().centre[1] = 0.125F;
    }
    return records;
}

/// The textbook's robust formula without a check for roots: along a ruling it returns 0, the line's
/// closest point to the centre.
Crossings with_phantoms(const ShapeRecord& record, const TrueRay& line) {
    const Vec3d middle = centre_of(record);
    const double nearest =
        dot(middle - line.origin, line.direction) / dot(line.direction, line.direction);
    const Vec3d o = line.origin + line.direction * nearest;
    const auto value = [&](double t) { return side_of_shape(record, o + line.direction * t); };
    const double c = value(0);
    const double a = 0.5 * (value(1) + value(-1)) - c;
    const double b = 0.25 * (value(1) - value(-1));
    Crossings out;
    if (b * b - a * c < 0) return out;
    const double root = std::sqrt(b * b - a * c);
    const double q = b < 0 ? root - b : -(b + root);
    for (const double t : {q == 0 ? 0 : c / q, q / a}) {
        const Vec3d room = size_of(record) - abs(o + line.direction * t - middle);
        if (room.x >= 0 && room.y >= 0 && room.z >= 0) out.add(nearest + t);
    }
    return out;
}

TEST(FormulaCheck, RuledQuadricsAreRightAndPhantomsAreSeen) {
    uint64_t phantoms = 0;
    for (const ShapeRecord& record : ruled_quadrics()) {
        Scene scene = empty_scene({});
        add_shape(scene, record, 0);
        const TrueScene truth(scene);
        EXPECT_EQ(check_formulas(truth, 20000, 1), (FormulaCheck{20000, 0, 0})) << record.k[1];
        CrossingFormulas wrong = formulas_in_double();
        wrong.shape = with_phantoms;
        const FormulaCheck seen = check_formulas(truth, 20000, 1, wrong);
        EXPECT_EQ(seen.wrong_truth, 0U);
        phantoms += seen.wrong;
        EXPECT_TRUE(record.k[9] != -0.09F || seen.wrong > 100) << "an open cylinder";
    }
    EXPECT_GT(phantoms, 200U);
}

/// The same mistake in a kernel, asked the rays of a check.
TEST(FormulaCheck, RaysAlongRulingsFindPhantomsInAKernel) {
    Scene scene = empty_scene({});
    add_shape(scene, ruled_quadrics()[0], 0);
    const TrueScene truth(scene);
    const RaySet rays(truth, few_rays(9216));
    const RayBatch batch = batches_of(rays)[0];
    AnswerList truths;
    compare_kernel(truth, batch, truth_kernel(truth), {}, {.answers = &truths});
    truths.is_truth = true;
    const Kernel kernel{"phantoms", [&](RayBlock& block, std::vector<Answer>& answers) {
                            truth_kernel(truth).ask(block, answers);
                            for (int i = 0; i < block.count(); ++i) {
                                const TrueRay ray = block.true_ray(i);
                                const Crossings met = with_phantoms(scene.shapes[0], ray);
                                for (int k = 0; k < met.count; ++k) {
                                    Answer& answer = answers[static_cast<size_t>(i)];
                                    if (met.t[k] > 0 && met.t[k] < answer.t)
                                        answer = {met.t[k], truth.item(0)};
                                }
                            }
                        }};
    const PairFigures figures = compare_kernel(truth, batch, kernel, {&truths}, {})[0];
    const Tally& special = figures.groups[static_cast<size_t>(RayGroup::special)];
    EXPECT_GT(special.of(Verdict::false_hit), 10U);
}

}  // namespace
}  // namespace obscura::crosscheck
