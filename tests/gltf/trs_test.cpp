// tests/gltf/trs_test.cpp - transforms are taken apart into translation, rotation and scale.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/trs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::gltf {
namespace {

void expect_equal(const Affined& a, const Affined& b) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(a.m[r][c], b.m[r][c], 1e-12 * (1 + std::abs(b.m[r][c]))) << r << ',' << c;
    }
}

TEST(Trs, PartsMakeTheTransformAgain) {
    // Each of the four components is the largest once; half turns have none to divide by but one.
    for (const std::array<double, 4>& turn : {std::array<double, 4>{0, 0, 0, 1},
                                              {1, 0, 0, 0},
                                              {0, 1, 0, 0},
                                              {0, 0, 1, 0},
                                              {0.8, 0.1, -0.3, 0.2},
                                              {0.1, -0.8, 0.3, 0.2},
                                              {0.1, 0.3, -0.8, -0.2},
                                              {0.1, 0.3, 0.2, -0.8}}) {
        GltfTrs trs;
        trs.rotation = turn;
        ASSERT_TRUE(normalize_quaternion(trs.rotation));
        trs.translation = {3, -4, 5};
        for (const std::array<double, 3>& scale : {std::array<double, 3>{1, 1, 1},
                                                   {0.01, 20, 3},
                                                   {-1, 2, 3},
                                                   {1, -2, 3},
                                                   {-1, -1, -1}}) {
            trs.scale = scale;
            const Affined whole = affine_from_trs(trs);
            const std::optional<GltfTrs> parts = trs_of(whole);
            ASSERT_TRUE(parts);
            expect_equal(affine_from_trs(*parts), whole);
        }
    }
}

TEST(Trs, WhatShearsOrIsFlatHasNone) {
    Affined shear;
    shear.m[0][1] = 0.01;
    EXPECT_FALSE(trs_of(shear));
    Affined flat;
    flat.m[1][1] = 0;
    EXPECT_FALSE(trs_of(flat));
    Affined infinite;
    infinite.m[0][0] = INFINITY;
    EXPECT_FALSE(trs_of(infinite));
}

}  // namespace
}  // namespace obscura::gltf
