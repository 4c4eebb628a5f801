// tests/crosscheck/formula_check_test.cpp - sides of shapes by hand, and formulas against them.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/formula_check.h"

#include "crosscheck/check_scenes.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using namespace test;

TEST(FormulaCheck, SidesOfShapes) {
    EXPECT_DOUBLE_EQ(side_of_shape(make_shape(ShapeKind::sphere, 2), {0, 3, 0}), 1);
    EXPECT_DOUBLE_EQ(side_of_shape(make_shape(ShapeKind::box, 1, 2, 3), {0.5, 0, 0}), -0.5);
    const ShapeRow cone = make_shape(ShapeKind::frustum, 1, 2, 0);
    EXPECT_DOUBLE_EQ(side_of_shape(cone, {0.75, 0, 0}), -0.25);
    EXPECT_DOUBLE_EQ(side_of_shape(cone, {0, 1.5, 0}), 0.5);
    // Equal balls: a cylinder between them.
    const ShapeRow capsule = make_shape(ShapeKind::capsule, 1, 0.5F, 0.5F);
    EXPECT_NEAR(side_of_shape(capsule, {0.7, 0.3, 0}), 0.2, 1e-9);
    EXPECT_NEAR(side_of_shape(capsule, {0, 2, 0}), 0.5, 1e-9);
    ShapeRow saddle = make_shape(ShapeKind::quadric, 1, 1, 1);
    saddle.k[0] = 1;
    saddle.k[2] = -1;
    saddle.k[7] = -2;
    EXPECT_DOUBLE_EQ(side_of_shape(saddle, {0.5, 0.25, 0.5}), -0.5);
}

/// One of each kind, moved away from the origin.
std::vector<ShapeRow> one_of_each() {
    std::vector<ShapeRow> rows = {make_shape(ShapeKind::sphere, 0.7F),
                                  make_shape(ShapeKind::box, 0.5F, 1, 2),
                                  make_shape(ShapeKind::frustum, 1, 0.5F, 0.2F),
                                  make_shape(ShapeKind::frustum, 1, 0.5F, 0),
                                  make_shape(ShapeKind::capsule, 0.6F, 0.5F, 0.3F),
                                  make_shape(ShapeKind::plane, 2, 1),
                                  make_shape(ShapeKind::plane, unbounded, unbounded),
                                  make_shape(ShapeKind::disk, 1, 0.3F),
                                  make_shape(ShapeKind::quadric, 1, 1, 1)};
    rows.back().k[0] = 1;
    rows.back().k[1] = -0.8F;
    rows.back().k[2] = 1.5F;
    rows.back().k[9] = -0.1F;
    for (ShapeRow& row : rows)
        row.centre[0] = 0.25F;
    return rows;
}

TEST(FormulaCheck, EveryShapeIsRight) {
    for (const ShapeRow& row : one_of_each()) {
        Scene scene = empty_scene({});
        add_shape(scene, row, 0);
        const TrueScene truth(scene);
        const FormulaCheck check = check_formulas(truth, 20000, 1);
        EXPECT_EQ(check.wrong, 0U) << "kind " << row.kind;
        EXPECT_EQ(check.segments, 20000U);
    }
}

TEST(FormulaCheck, TrianglesAreRight) {
    const Scene scene = closed_cube();
    EXPECT_EQ(check_formulas(TrueScene(scene), 20000, 1).wrong, 0U);
}

}  // namespace
}  // namespace obscura
