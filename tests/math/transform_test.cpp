// tests/math/transform_test.cpp - affine maps, their inverses, and their effect on normals.
// SPDX-License-Identifier: Apache-2.0
#include "math/transform.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"
#include <cmath>

namespace obscura {
namespace {

double between(Pcg32& random, double low, double high) {
    return low + (high - low) * random.next_double();
}

Vec3d random_vector(Pcg32& random) {
    const double x = between(random, -1, 1);
    const double y = between(random, -1, 1);
    return {x, y, between(random, -1, 1)};
}

/// Rotation about an axis of the frame.
Affined turn(int axis, double angle) {
    Affined a;
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    a.m[i][i] = std::cos(angle);
    a.m[i][j] = -std::sin(angle);
    a.m[j][i] = std::sin(angle);
    a.m[j][j] = std::cos(angle);
    return a;
}

/// Rotation, uneven scale (mirrored half of the time), rotation, translation. The product of scales
/// goes to `volume`.
Affined random_affine(Pcg32& random, double& volume) {
    Affined scale;
    volume = 1;
    for (int i = 0; i < 3; ++i) {
        scale.m[i][i] = std::pow(10.0, between(random, -2, 2));
        if (random.next_uint() % 2 == 0) scale.m[i][i] = -scale.m[i][i];
        volume *= scale.m[i][i];
    }
    Affined a = turn(0, between(random, 0, 6.3));
    a = compose(scale, compose(turn(1, between(random, 0, 6.3)), a));
    a = compose(turn(2, between(random, 0, 6.3)), a);
    for (auto& row : a.m)
        row[3] = between(random, -1000, 1000);
    return a;
}

TEST(Transform, InverseTimesMapIsTheIdentity) {
    Pcg32 random(1);
    for (int n = 0; n < 2000; ++n) {
        double volume = 0;
        const Affined a = random_affine(random, volume);
        const Affined products[] = {compose(inverse(a), a), compose(a, inverse(a))};
        for (const Affined& product : products) {
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 4; ++c) {
                    const double scale = c == 3 ? 1e5 : 1;  // translations go through 1/scale
                    ASSERT_NEAR(product.m[r][c], r == c ? 1.0 : 0.0, 1e-10 * scale);
                }
            }
        }
    }
}

TEST(Transform, DeterminantIsTheSignedVolume) {
    Pcg32 random(2);
    for (int n = 0; n < 2000; ++n) {
        double volume = 0;
        const Affined a = random_affine(random, volume);
        EXPECT_NEAR(determinant(a) / volume, 1, 1e-10);
        EXPECT_NEAR(determinant(inverse(a)) * volume, 1, 1e-8);
    }
}

TEST(Transform, NormalsStayPerpendicularUnderUnevenScale) {
    Pcg32 random(3);
    for (int n = 0; n < 2000; ++n) {
        double volume = 0;
        const Affined a = random_affine(random, volume);
        const Vec3d e1 = random_vector(random);
        const Vec3d e2 = random_vector(random);
        const Vec3d normal = normalize(transform_normal(inverse(a), normalize(cross(e1, e2))));
        for (const Vec3d& edge : {e1, e2, e1 - e2}) {
            ASSERT_NEAR(dot(normal, normalize(transform_vector(a, edge))), 0, 1e-9);
        }
        // Up to the mirror's sign it is the normal of the mapped triangle.
        const Vec3d mapped = normalize(cross(transform_vector(a, e1), transform_vector(a, e2)));
        ASSERT_NEAR(dot(normal, mapped), volume < 0 ? -1 : 1, 1e-9);
    }
}

TEST(Transform, ComposeAppliesTheSecondFirst) {
    Pcg32 random(4);
    for (int n = 0; n < 1000; ++n) {
        double volume = 0;
        const Affined a = random_affine(random, volume);
        const Affined b = random_affine(random, volume);
        const Vec3d p = random_vector(random);
        const Vec3d one = transform_point(compose(a, b), p);
        const Vec3d two = transform_point(a, transform_point(b, p));
        ASSERT_LT(length(one - two), 1e-9 * (1 + length(two)));
        const Vec3d moved = transform_point(a, p) - transform_point(a, Vec3d{0, 0, 0});
        ASSERT_LT(length(moved - transform_vector(a, p)), 1e-9);
    }
}

TEST(Transform, DefaultIsTheIdentityAndTranslationIsColumnThree) {
    const Vec3f p{1.0F, -2.0F, 3.5F};
    const Vec3f same = transform_point(Affinef{}, p);
    EXPECT_EQ(same.x, p.x);
    EXPECT_EQ(same.y, p.y);
    EXPECT_EQ(same.z, p.z);
    Affinef moved;
    moved.m[1][3] = 10.0F;
    EXPECT_EQ(transform_point(moved, p).y, 8.0F);
    EXPECT_EQ(transform_vector(moved, p).y, -2.0F);
}

TEST(Transform, FloatsAndLanesAgreeWithDouble) {
    Pcg32 random(5);
    for (int n = 0; n < 500; ++n) {
        double volume = 0;
        const Affined a = random_affine(random, volume);
        const auto narrow = affine_cast<float>(a);
        const auto lanes = affine_cast<Lanes>(narrow);
        const Vec3d p = random_vector(random);
        const Vec3f q{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        const Vec3d truth = transform_point(a, p);
        const Vec3f one = transform_point(narrow, q);
        const Vec3f many =
            test::lane(transform_point(lanes, Vec3<Lanes>{q.x, q.y, q.z}), lane_count - 1);
        const double bound = 1e-6 * 1400;
        ASSERT_LT(length(Vec3d{one.x, one.y, one.z} - truth), bound);
        ASSERT_LT(length(Vec3d{many.x, many.y, many.z} - truth), bound);
    }
}

}  // namespace
}  // namespace obscura
