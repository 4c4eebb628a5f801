// tests/math/exact_test.cpp - exact sums and products keep what rounding discards.
// SPDX-License-Identifier: Apache-2.0
#include "math/exact.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"
#include <cmath>

namespace obscura {
namespace {

using test::lane;

float random_float(Pcg32& random) {
    return std::ldexp(random.next_float() - 0.5F, static_cast<int>(random.next_uint() % 40U) - 20);
}

TEST(Exact, SumsAndProductsAreWhole) {
    Pcg32 random(1);
    for (int i = 0; i < 100000; ++i) {
        const float a = random_float(random);
        const float b = random_float(random);
        const double product = static_cast<double>(a) * static_cast<double>(b);
        const Exact<float> one = two_product(a, b);
        ASSERT_EQ(static_cast<double>(one.value) + static_cast<double>(one.error), product);
        const Exact<Lanes> many = two_product(Lanes(a), Lanes(b));
        ASSERT_EQ(lane(many.value, 0), one.value);
        ASSERT_EQ(lane(many.error, 0), one.error);
        const Exact<Lanes> sum = two_sum(Lanes(a), Lanes(b));
        ASSERT_EQ(static_cast<double>(lane(sum.value, 0)) + static_cast<double>(lane(sum.error, 0)),
                  static_cast<double>(a) + static_cast<double>(b));
    }
}

TEST(Exact, MultiplyAddRoundsOnce) {
    Pcg32 random(2);
    for (int i = 0; i < 100000; ++i) {
        const float a = random_float(random);
        const float b = random_float(random);
        const float c = -a * b * (1.0F + (random.next_float() - 0.5F) * 1e-6F);  // cancels
        const auto exact = static_cast<float>(
            std::fma(static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)));
        const float least = std::fabs(exact) * 1.2e-7F;
        ASSERT_NEAR(multiply_add(a, b, c), exact, least);
        ASSERT_NEAR(lane(multiply_add(Lanes(a), Lanes(b), Lanes(c)), 0), exact, least);
    }
}

TEST(Exact, NearlyEqualProductsKeepTheirDifference) {
    const float a = 94906267.0F / 4096.0F;
    EXPECT_EQ(difference_of_products(a, a, a, a), 0.0F);
    const float b = std::nextafter(a, 0.0F);
    const double exact = static_cast<double>(a) * static_cast<double>(a) -
                         static_cast<double>(b) * static_cast<double>(b);
    EXPECT_FLOAT_EQ(difference_of_products(a, a, b, b), static_cast<float>(exact));
    EXPECT_FLOAT_EQ(lane(difference_of_products(Lanes(a), Lanes(a), Lanes(b), Lanes(b)), 0),
                    static_cast<float>(exact));
}

}  // namespace
}  // namespace obscura
