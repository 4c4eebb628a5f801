// tests/denoise/give_back_test.cpp - planes, outliers, and light that goes back.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/give_back.h"

#include "denoise/outliers.h"
#include "denoise/weights.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

Plane constant(int width, int height, float value) {
    return make_plane(width, height, plane_border, [=](int /*x*/, int /*y*/) { return value; });
}

double sum(const Plane& plane) {
    double total = 0;
    for (int y = 0; y < plane.height(); ++y) {
        for (int x = 0; x < plane.width(); ++x)
            total += static_cast<double>(plane.row(y)[x]);
    }
    return total;
}

TEST(Planes, BorderIsTheNearestPixel) {
    const Plane plane =
        make_plane(3, 2, plane_border, [](int x, int y) { return static_cast<float>(10 * y + x); });
    EXPECT_EQ(plane.row(-plane_border)[-plane_border], 0);
    EXPECT_EQ(plane.row(5)[4], 12);
    EXPECT_EQ(plane.row(1)[-2], 10);
}

TEST(Planes, ABlurIsTheMeanOfASquare) {
    Plane plane = constant(9, 9, 0);
    plane.row(4)[4] = 25;
    const Plane blurred = box_blur(plane, 2);
    EXPECT_FLOAT_EQ(blurred.row(4)[4], 1);
    EXPECT_FLOAT_EQ(blurred.row(2)[6], 1);
    EXPECT_FLOAT_EQ(blurred.row(1)[4], 0);
}

TEST(Weights, FallOffLikeTheExponential) {
    for (float x = 0; x < 12; x += 0.1f)
        EXPECT_NEAR(falloff(x), std::exp(-x), 0.036) << x;
    EXPECT_EQ(falloff(-3), 1);
    EXPECT_EQ(falloff(8), 0);
}

TEST(GiveBack, AllOfItComesBackAndNoPixelGetsMuch) {
    for (const float light : {30.0f, 3e5f}) {
        Rgb taken;
        taken.fill(constant(150, 70, 0));
        taken[0].row(33)[40] = light;
        const Plane shine = constant(150, 70, 1);
        const Rgb back = GiveBack(taken, shine, shine).spread(taken);
        EXPECT_NEAR(sum(back[0]), static_cast<double>(light), 1e-4 * static_cast<double>(light));
        EXPECT_EQ(sum(back[1]), 0);
        // Of so much light the whole image has to take more than cells are meant to.
        const double everywhere = static_cast<double>(light) / (150 * 70);
        EXPECT_LT(back[0].row(33)[40], 0.4 + 3 * everywhere);
    }
}

/// However unequally pixels receive, all comes back, and light stays light.
TEST(GiveBack, NoPixelPaysForOthers) {
    Rgb taken;
    taken.fill(constant(150, 70, 0));
    taken[0].row(40)[40] = 5;
    const Plane shine = constant(150, 70, 1);
    const Plane receives = make_plane(150, 70, plane_border, [](int x, int y) {
        return x / 16 == 2 && y / 16 == 2 ? 1.0f : 0.3f;
    });
    const Rgb back = GiveBack(taken, shine, receives).spread(taken);
    EXPECT_NEAR(sum(back[0]), 5, 1e-4);
    for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 150; ++x)
            ASSERT_GE(back[0].row(y)[x], 0) << x << ' ' << y;
    }
}

TEST(GiveBack, NothingGoesWhereNothingIsReceived) {
    Rgb taken;
    taken.fill(constant(64, 64, 0));
    taken[2].row(10)[10] = 5;
    Plane receives = constant(64, 64, 0);
    receives.row(60)[60] = 1;
    const Rgb back = GiveBack(taken, constant(64, 64, 1), receives).spread(taken);
    EXPECT_NEAR(back[2].row(60)[60], 5, 1e-4);
    EXPECT_EQ(back[2].row(10)[10], 0);
}

TEST(Outliers, AreBrightInOneHalfAlone) {
    Rgb halves[2];
    for (Rgb& half : halves)
        half.fill(constant(20, 20, 1));
    for (size_t c = 0; c < 3; ++c) {
        halves[0][c].row(5)[5] = 90;    // in one half
        halves[0][c].row(12)[12] = 80;  // in both
        halves[1][c].row(12)[12] = 100;
    }
    const Outliers found = find_outliers(halves[0], halves[1]);
    EXPECT_NEAR(found.keep[0].row(5)[5] * 90, 2, 1e-4);  // twice the other half
    EXPECT_EQ(found.keep[1].row(5)[5], 1);
    EXPECT_EQ(found.keep[0].row(12)[12], 1);
    EXPECT_EQ(found.keep[1].row(12)[12], 1);
    EXPECT_DOUBLE_EQ(found.share, 1.0 / 400);
}

TEST(Outliers, ALineOfLightIsNone) {
    Rgb halves[2];
    for (Rgb& half : halves)
        half.fill(constant(20, 20, 1));
    for (size_t c = 0; c < 3; ++c) {
        for (int x = 0; x < 20; ++x)
            halves[x % 2][c].row(7)[x] = 50;  // noisy: now in one half, now in the other
    }
    const Outliers found = find_outliers(halves[0], halves[1]);
    for (const Plane& keep : found.keep) {
        for (int x = 2; x < 18; ++x)  // the ends at the image's edge have too few neighbours
            EXPECT_EQ(keep.row(7)[x], 1.0f) << x;
    }
}

}  // namespace
}  // namespace obscura
