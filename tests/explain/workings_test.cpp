// tests/explain/workings_test.cpp - worked-out formulas against numbers by hand and definitions.
// SPDX-License-Identifier: Apache-2.0
#include "explain/workings.h"

#include "crosscheck/random.h"
#include "crosscheck/shape_side.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <cmath>

namespace obscura::test {
namespace {

double value_of(const Working& working, const std::string& name) {
    for (const Term& term : working.terms) {
        if (term.name == name || term.name.rfind(name + " = ", 0) == 0) return term.value[0];
    }
    ADD_FAILURE() << name << " is not among the terms";
    return NAN;
}

TEST(Workings, SphereByHand) {
    const ShapeRecord ball = make_shape(ShapeKind::sphere, 1);
    const Working met = work_out_shape(ball, {{0, 0, 5}, {0, 0, -1}});
    EXPECT_EQ(value_of(met, "a"), 1);
    EXPECT_EQ(value_of(met, "b"), -5);
    EXPECT_EQ(value_of(met, "c"), 24);
    EXPECT_EQ(value_of(met, "D"), 1);
    EXPECT_EQ(met.t, (std::vector<double>{4, 6}));
    EXPECT_EQ(work_out_shape(ball, {{1, 0, 5}, {0, 0, -1}}).t, (std::vector<double>{5, 5}));
    const Working missed = work_out_shape(ball, {{2, 0, 5}, {0, 0, -1}});
    EXPECT_EQ(value_of(missed, "D"), -3);
    EXPECT_EQ(missed.missed, "D < 0: the ray passes by");
}

TEST(Workings, TriangleByHand) {
    const Triangle<double> sail{{1, 2, 0}, {3, 2, 0}, {1, 5, 0}};
    const Working met = work_out_triangle(sail, {{2, 3, 5}, {0, 0, -2}});
    EXPECT_EQ(value_of(met, "det"), 12);
    EXPECT_EQ(value_of(met, "u"), 0.5);
    EXPECT_DOUBLE_EQ(value_of(met, "v"), 1.0 / 3);
    EXPECT_EQ(met.t, std::vector<double>{2.5});
    EXPECT_LT(met.outside, 0);
    EXPECT_EQ(work_out_triangle(sail, {{0, 3, 5}, {0, 0, -2}}).missed, "u < 0: outside");
    EXPECT_EQ(work_out_triangle(sail, {{2, 0, 5}, {0, 0, -2}}).missed, "v < 0: outside");
    EXPECT_EQ(work_out_triangle(sail, {{3, 5, 5}, {0, 0, -2}}).missed, "u + v > 1: outside");
    EXPECT_EQ(work_out_triangle(sail, {{0, 3, 5}, {1, 0, 0}}).missed,
              "det = 0: the ray runs along the triangle");
}

TEST(Workings, ARayAlongARulingMeetsNothingButWhatLiesAcross) {
    ShapeRecord pipe = make_shape(ShapeKind::quadric, 2, 2, 2);  // x^2 + z^2 = 1, open
    pipe.k[0] = pipe.k[2] = 1;
    pipe.k[9] = -1;
    const Working along = work_out_shape(pipe, {{0.5, 5, 0}, {0, -1, 0}});
    EXPECT_EQ(value_of(along, "a"), 0);
    EXPECT_EQ(value_of(along, "b"), 0);
    EXPECT_TRUE(along.t.empty());
    EXPECT_EQ(along.missed, "the ray runs along the surface: nothing depends on t");
    const ShapeRecord can = make_shape(ShapeKind::frustum, 2, 1, 1);
    EXPECT_EQ(work_out_shape(can, {{0.5, 5, 0}, {0, -1, 0}}).t, (std::vector<double>{3, 7}));
    EXPECT_TRUE(work_out_shape(can, {{1.5, 5, 0}, {0, -1, 0}}).t.empty());
    const ShapeRecord floor = make_shape(ShapeKind::plane, unbounded, unbounded);
    EXPECT_EQ(work_out_shape(floor, {{0, 1, 0}, {1, 0, 0}}).missed,
              "R_d . n = 0: the ray runs along it");
}

/// Closed shapes and a quadric without a box that would cut it.
std::vector<ShapeRecord> closed_shapes() {
    std::vector<ShapeRecord> records = {make_shape(ShapeKind::sphere, 0.9F),
                                        make_shape(ShapeKind::box, 0.5F, 0.9F, 0.7F),
                                        make_shape(ShapeKind::frustum, 0.8F, 0.6F, 0.6F),
                                        make_shape(ShapeKind::frustum, 0.8F, 0.9F, 0),
                                        make_shape(ShapeKind::frustum, 0.8F, 0.3F, 0.7F),
                                        make_shape(ShapeKind::capsule, 0.5F, 0.4F, 0.4F),
                                        make_shape(ShapeKind::capsule, 0.5F, 0.5F, 0.2F),
                                        make_shape(ShapeKind::quadric, 2, 2, 2)};
    const float egg[10] = {1, 2, 3, 0.3F, -0.2F, 0.1F, 0.2F, -0.1F, 0.3F, -0.8F};
    std::copy_n(egg, 10, records.back().k);
    for (ShapeRecord& record : records) {
        record.centre[0] = 0.25F;
        record.centre[2] = -0.5F;
    }
    return records;
}

/// Worked-out hits lie where the shape's own definition changes its sign, and none is missing:
/// elsewhere along the ray the sign does not change.
TEST(Workings, RootsAreWhereTheDefinitionChangesItsSign) {
    size_t met = 0;
    for (const ShapeRecord& record : closed_shapes()) {
        for (uint64_t i = 0; i < 400; ++i) {
            crosscheck::RandomStream random(i);
            const Vec3d from = random.direction() * 4.0;
            const Vec3d to = random.direction() * 1.1;
            const crosscheck::TrueRay ray{from, to - from};
            const Working working = work_out_shape(record, ray);
            const auto inside = [&](double t) {
                return crosscheck::side_of_shape(record, ray.origin + ray.direction * t) < 0;
            };
            ASSERT_EQ(working.t.empty(), !working.missed.empty());
            ASSERT_EQ(working.t.size() % 2, 0U) << record.kind;
            bool now = false;
            double before = 0;
            for (const double t : working.t) {
                for (int k = 1; k < 20; ++k) {
                    const double share = before + (t - before) * k / 20;
                    if (t - before > 1e-5) {
                        ASSERT_EQ(inside(share), now) << record.kind << " " << i;
                    }
                }
                now = !now;
                before = t;
                ++met;
            }
            for (int k = 1; k < 40; ++k)
                ASSERT_EQ(inside(before + k * 0.05 + 1e-6), now) << record.kind << " " << i;
        }
    }
    EXPECT_GT(met, 2000U);
}

}  // namespace
}  // namespace obscura::test
