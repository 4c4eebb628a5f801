// tests/math/lanes_test.cpp - every operation on lanes against the same one on scalars.
// SPDX-License-Identifier: Apache-2.0
#include "math/lanes.h"

#include "math/reverse_bits.h"
#include "math/vec.h"
#include "math/warp.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"
#include <cmath>
#include <limits>
#include <vector>

namespace obscura {
namespace {

using test::lane;
using test::make_lanes;
using test::make_mask;
using test::same_number;

/// Numbers on which implementations tend to differ.
const std::vector<float>& odd_floats() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    static const std::vector<float> values = {
        0.0F,      -0.0F,       1.0F,       -1.0F,
        0.5F,      -0.5F,       1.5F,       -2.5F,
        0.99F,     -0.99F,      3.14159F,   1e-3F,
        -1e-3F,    16777216.0F, -8388609,   1e30F,
        -1e30F,    1e-30F,      2e38F,      1.2e-38F,
        infinity,  -infinity,   123.75F,    -4567.25F,
        2.999999F, 0.33333F,    8388607.5F, std::numeric_limits<float>::quiet_NaN()};
    return values;
}

const std::vector<int32_t>& odd_integers() {
    static const std::vector<int32_t> values = {0,
                                                1,
                                                -1,
                                                2,
                                                -2,
                                                7,
                                                255,
                                                -256,
                                                65535,
                                                1 << 20,
                                                -4321,
                                                123456,
                                                -7654321,
                                                2147483647,
                                                -2147483647 - 1};
    return values;
}

template <typename T>
auto odd_lanes(const std::vector<T>& values, size_t first) {
    return make_lanes(
        [&](int i) { return values[(first + static_cast<size_t>(i)) % values.size()]; });
}

/// Calls check(a, b) with lanes that together hold every pair of values.
template <typename T, typename Check>
void for_all_pairs(const std::vector<T>& values, const Check& check) {
    for (size_t first = 0; first < values.size(); first += static_cast<size_t>(lane_count)) {
        for (size_t shift = 0; shift < values.size(); ++shift) {
            check(odd_lanes(values, first), odd_lanes(values, first + shift));
        }
    }
}

TEST(Lanes, FloatArithmeticIsTheScalarsToTheLastBit) {
    for_all_pairs(odd_floats(), [](Lanes a, Lanes b) {
        for (int i = 0; i < lane_count; ++i) {
            const float x = lane(a, i);
            const float y = lane(b, i);
            EXPECT_TRUE(same_number(lane(a + b, i), x + y)) << x << " + " << y;
            EXPECT_TRUE(same_number(lane(a - b, i), x - y)) << x << " - " << y;
            EXPECT_TRUE(same_number(lane(a * b, i), x * y)) << x << " * " << y;
            EXPECT_TRUE(same_number(lane(a / b, i), x / y)) << x << " / " << y;
            EXPECT_TRUE(same_number(lane(min(a, b), i), min(x, y))) << "min " << x << ", " << y;
            EXPECT_TRUE(same_number(lane(max(a, b), i), max(x, y))) << "max " << x << ", " << y;
        }
    });
}

TEST(Lanes, FloatComparisonsAreTheScalars) {
    for_all_pairs(odd_floats(), [](Lanes a, Lanes b) {
        for (int i = 0; i < lane_count; ++i) {
            const float x = lane(a, i);
            const float y = lane(b, i);
            EXPECT_EQ(lane(a < b, i), x < y) << x << ", " << y;
            EXPECT_EQ(lane(a <= b, i), x <= y) << x << ", " << y;
            EXPECT_EQ(lane(a > b, i), x > y) << x << ", " << y;
            EXPECT_EQ(lane(a >= b, i), x >= y) << x << ", " << y;
            EXPECT_EQ(lane(a == b, i), x == y) << x << ", " << y;
            EXPECT_EQ(lane(a != b, i), x != y) << x << ", " << y;
        }
    });
}

TEST(Lanes, NormalizeNeverMakesWhatIsNoNumber) {
    for (const float size : {0.0F, 1e-30F, 1.0F, 1e18F, 1e20F, 3e38F}) {
        const Vec3<Lanes> unit = normalize(Vec3<Lanes>{Lanes(size), Lanes(0.0F), Lanes(-size)});
        EXPECT_TRUE(std::isfinite(lane(unit.x, 0)) && lane(unit.z, 0) == -lane(unit.x, 0)) << size;
        if (size > 1e-15F && size < 1e19F) {
            EXPECT_NEAR(lane(unit.x, 0), std::sqrt(0.5), 1e-6);
        }
    }
}

TEST(Lanes, InverseSquareRootIsGoodToFourUlp) {
    for (double number = 1e-36; number < 1e37; number *= 1.0137) {
        const auto x = static_cast<float>(number);
        const double expected = 1 / std::sqrt(static_cast<double>(x));
        EXPECT_NEAR(lane(inverse_sqrt(Lanes(x)), 0) / expected, 1, 4 * 0x1p-24) << x;
        EXPECT_NEAR(inverse_sqrt(x) / expected, 1, 4 * 0x1p-24) << x;
        EXPECT_NEAR(inverse_sqrt(number) * std::sqrt(number), 1, 1e-15) << number;
    }
}

TEST(Lanes, SingleFloatOperationsAreTheScalars) {
    for (size_t first = 0; first < odd_floats().size(); ++first) {
        const Lanes a = odd_lanes(odd_floats(), first);
        for (int i = 0; i < lane_count; ++i) {
            const float x = lane(a, i);
            EXPECT_TRUE(same_number(lane(-a, i), -x)) << x;
            EXPECT_TRUE(same_number(lane(abs(a), i), abs(x))) << x;
            EXPECT_TRUE(same_number(lane(floor(a), i), floor(x))) << x;
            EXPECT_TRUE(same_number(lane(sqrt(a), i), sqrt(x))) << x;
            EXPECT_EQ(lane(float_bits(a), i), float_bits(x)) << x;
            EXPECT_TRUE(same_number(lane(bits_float(float_bits(a)), i), x)) << x;
            if (std::fabs(x) < 2e9F) {
                EXPECT_EQ(lane(to_int(a), i), to_int(x)) << x;
            }
        }
    }
}

TEST(Lanes, IntegerOperationsWrapLikeTwosComplement) {
    for_all_pairs(odd_integers(), [](LanesI a, LanesI b) {
        for (int i = 0; i < lane_count; ++i) {
            const int32_t x = lane(a, i);
            const int32_t y = lane(b, i);
            EXPECT_EQ(lane(a + b, i), as_int(as_uint(x) + as_uint(y))) << x << " + " << y;
            EXPECT_EQ(lane(a - b, i), as_int(as_uint(x) - as_uint(y))) << x << " - " << y;
            EXPECT_EQ(lane(a * b, i), as_int(as_uint(x) * as_uint(y))) << x << " * " << y;
            EXPECT_EQ(lane(a & b, i), x & y);
            EXPECT_EQ(lane(a | b, i), x | y);
            EXPECT_EQ(lane(a < b, i), x < y) << x << ", " << y;
            EXPECT_EQ(lane(a > b, i), x > y) << x << ", " << y;
            EXPECT_EQ(lane(a <= b, i), x <= y) << x << ", " << y;
            EXPECT_EQ(lane(a >= b, i), x >= y) << x << ", " << y;
            EXPECT_EQ(lane(a == b, i), x == y) << x << ", " << y;
            EXPECT_EQ(lane(a != b, i), x != y) << x << ", " << y;
            EXPECT_EQ(lane(min(a, b), i), min(x, y));
            EXPECT_EQ(lane(max(a, b), i), max(x, y));
        }
    });
}

TEST(Lanes, UnsignedOperationsAreUnsigned) {
    for_all_pairs(odd_integers(), [](LanesI signed_a, LanesI signed_b) {
        const LanesU a = as_uint(signed_a);
        const LanesU b = as_uint(signed_b);
        for (int i = 0; i < lane_count; ++i) {
            const uint32_t x = lane(a, i);
            const uint32_t y = lane(b, i);
            EXPECT_EQ(x, as_uint(lane(signed_a, i)));
            EXPECT_EQ(lane(as_int(a), i), lane(signed_a, i));
            EXPECT_EQ(lane(a + b, i), x + y);
            EXPECT_EQ(lane(a - b, i), x - y);
            EXPECT_EQ(lane(a * b, i), x * y);
            EXPECT_EQ(lane(a & b, i), x & y);
            EXPECT_EQ(lane(a | b, i), x | y);
            EXPECT_EQ(lane(a ^ b, i), x ^ y);
            EXPECT_EQ(lane(a == b, i), x == y);
            EXPECT_EQ(lane(a != b, i), x != y);
            EXPECT_EQ(lane(a < b, i), x < y) << x << ", " << y;
        }
    });
}

TEST(Lanes, ShiftsAreLogical) {
    const LanesU a = make_lanes([](int i) { return 0x80000001U + 0x01234567U * unsigned(i); });
    for (int shift = 0; shift < 32; ++shift) {
        for (int i = 0; i < lane_count; ++i) {
            EXPECT_EQ(lane(a >> shift, i), lane(a, i) >> shift) << shift;
            EXPECT_EQ(lane(a << shift, i), lane(a, i) << shift) << shift;
        }
    }
}

TEST(Lanes, ReversedBitsComeBackToFront) {
    for (int bit = 0; bit < 32; ++bit) {
        EXPECT_EQ(reverse_bits(1U << bit), 0x80000000U >> bit);
    }
    Pcg32 random(1);
    for (int n = 0; n < 1000; ++n) {
        const LanesU a = make_lanes([&](int) { return random.next_uint(); });
        const LanesU reversed = reverse_bits(a);
        for (int i = 0; i < lane_count; ++i) {
            uint32_t expected = 0;
            for (int bit = 0; bit < 32; ++bit)
                expected |= (lane(a, i) >> bit & 1U) << (31 - bit);
            ASSERT_EQ(lane(reversed, i), expected);
            ASSERT_EQ(reverse_bits(lane(a, i)), expected);
        }
    }
}

TEST(Lanes, MaskOperationsCountTheirBits) {
    constexpr uint32_t whole = (1U << lane_count) - 1U;
    const uint32_t step = lane_count > 8 ? 37U : 1U;
    EXPECT_EQ(mask_bits(Mask(true)), whole);
    EXPECT_EQ(mask_bits(Mask(false)), 0U);
    for (uint32_t bits = 0; bits <= whole; bits += step) {
        const Mask mask = make_mask(bits);
        const uint32_t other = (bits * 0x9E3779B9U) >> 16 & whole;
        EXPECT_EQ(mask_bits(mask), bits);
        EXPECT_EQ(mask_bits(!mask), ~bits & whole);
        EXPECT_EQ(mask_bits(mask & make_mask(other)), bits & other);
        EXPECT_EQ(mask_bits(mask | make_mask(other)), bits | other);
        EXPECT_EQ(any(mask), bits != 0);
        EXPECT_EQ(none(mask), bits == 0);
        EXPECT_EQ(all(mask), bits == whole);
        EXPECT_EQ(count(mask), __builtin_popcount(bits));
    }
    EXPECT_TRUE(all(make_mask(whole)));
}

TEST(Lanes, SelectTakesTheFirstWhereTrue) {
    const Lanes a = make_lanes([](int i) { return static_cast<float>(i); });
    const Lanes b = make_lanes([](int i) { return -1.0F - static_cast<float>(i); });
    for (uint32_t bits = 0; bits<1U << lane_count; bits += lane_count> 8 ? 91U : 1U) {
        const Mask mask = make_mask(bits);
        for (int i = 0; i < lane_count; ++i) {
            const bool first = (bits >> i & 1U) != 0;
            EXPECT_EQ(lane(select(mask, a, b), i), first ? lane(a, i) : lane(b, i));
            EXPECT_EQ(lane(select(mask, LanesI(-7), lane_numbers()), i), first ? -7 : i);
            EXPECT_EQ(lane(select(mask, LanesU(0xFFFFFFFFU), LanesU(3U)), i),
                      first ? 0xFFFFFFFFU : 3U);
        }
    }
    EXPECT_EQ(select(true, 1.0, 2.0), 1.0);
    EXPECT_EQ(select(false, 1, 2), 2);
}

/// Checks a function of lanes against the one in double; error in units of max(1, |value|).
template <typename OfLanes, typename Exact>
void expect_close(
    const OfLanes& of_lanes, const Exact& exact, double low, double high, double error) {
    Pcg32 random(3);
    for (int n = 0; n < 4000; ++n) {
        const Lanes x = make_lanes(
            [&](int) { return static_cast<float>(low + (high - low) * random.next_double()); });
        const Lanes y = of_lanes(x);
        for (int i = 0; i < lane_count; ++i) {
            const double truth = exact(static_cast<double>(lane(x, i)));
            const double difference = std::abs(lane(y, i) - truth) / std::max(1.0, std::abs(truth));
            ASSERT_LE(difference, error) << "x " << lane(x, i) << ", got " << lane(y, i);
        }
    }
}

TEST(Lanes, FunctionsAgreeWithTheStandardLibrary) {
    expect_close([](Lanes x) { return sin_cos(x).sin; },
                 [](double x) { return std::sin(x); },
                 -20,
                 20,
                 3e-7);
    expect_close([](Lanes x) { return sin_cos(x).cos; },
                 [](double x) { return std::cos(x); },
                 -20,
                 20,
                 3e-7);
    expect_close(
        [](Lanes x) { return exp(x); }, [](double x) { return std::exp(x); }, -80, 80, 1e-6);
    expect_close(
        [](Lanes x) { return log2(x); }, [](double x) { return std::log2(x); }, 1e-6, 100, 3e-7);
    expect_close(
        [](Lanes x) { return acos(x); }, [](double x) { return std::acos(x); }, -1, 1, 5e-7);
    for (const float y : {-2.0F, -0.5F, 0.25F, 7.0F}) {
        expect_close([&](Lanes x) { return atan2(Lanes(y), x); },
                     [&](double x) { return std::atan2(static_cast<double>(y), x); },
                     -5,
                     5,
                     5e-7);
    }
    for (const float x : {1e-12F, 1e12F, 0.03125F, 1.0F}) {
        EXPECT_NEAR(lane(log2(Lanes(x)), 0), std::log2(x), 4e-6) << x;
    }
}

TEST(Lanes, LoadAndStoreNeedNoAlignment) {
    float floats[lane_count + 3];
    int32_t integers[lane_count + 3];
    uint32_t words[lane_count + 3];
    for (int i = 0; i < lane_count + 3; ++i) {
        floats[i] = 0.5F * static_cast<float>(i);
        integers[i] = -i;
        words[i] = 0xFFFFFF00U + unsigned(i);
    }
    for (int shift = 0; shift < 4; ++shift) {
        for (int i = 0; i < lane_count; ++i) {
            EXPECT_EQ(lane(load(floats + shift), i), floats[i + shift]);
            EXPECT_EQ(lane(load(integers + shift), i), integers[i + shift]);
            EXPECT_EQ(lane(load(words + shift), i), words[i + shift]);
            EXPECT_EQ(lane(lane_numbers(), i), i);
        }
    }
    store(floats + 1, Lanes(9.0F));
    EXPECT_EQ(floats[0], 0.0F);
    EXPECT_EQ(floats[1], 9.0F);
    EXPECT_EQ(floats[lane_count], 9.0F);
    EXPECT_EQ(floats[lane_count + 1], 0.5F * static_cast<float>(lane_count + 1));
}

TEST(Lanes, GatherReadsEachLanesOwnEntry) {
    constexpr int entries = 1000;
    std::vector<float> floats(entries);
    std::vector<int32_t> integers(entries);
    std::vector<uint32_t> words(entries);
    for (size_t i = 0; i < entries; ++i) {
        floats[i] = 1.5F * static_cast<float>(i);
        integers[i] = -3 * static_cast<int32_t>(i);
        words[i] = 0xF0000000U + static_cast<uint32_t>(i);
    }
    Pcg32 random(5);
    for (int n = 0; n < 100; ++n) {
        const LanesI at =
            make_lanes([&](int) { return static_cast<int32_t>(random.next_uint() % entries); });
        for (int i = 0; i < lane_count; ++i) {
            const auto index = static_cast<size_t>(lane(at, i));
            EXPECT_EQ(lane(gather<Lanes>(floats.data(), at), i), floats[index]);
            EXPECT_EQ(lane(gather<Lanes>(integers.data(), at), i), integers[index]);
            EXPECT_EQ(lane(gather<Lanes>(words.data(), at), i), words[index]);
        }
    }
    EXPECT_EQ(gather<double>(floats.data(), 4), 6.0);
}

TEST(Lanes, PackerKeepsOrderForEveryMask) {
    const Lanes a = make_lanes([](int i) { return 100.0F + static_cast<float>(i); });
    for (uint32_t bits = 0; bits < 1U << lane_count; ++bits) {
        const auto packed = test::lane_array(Packer(make_mask(bits))(a));
        size_t next = 0;
        for (int i = 0; i < lane_count; ++i) {
            if ((bits >> i & 1U) == 0) continue;
            ASSERT_EQ(packed[next++], 100.0F + static_cast<float>(i)) << "mask " << bits;
        }
    }
}

TEST(Lanes, HelpersAgreeForEveryValueType) {
    for (int32_t exponent = 1; exponent <= 254; ++exponent) {
        const float expected = std::ldexp(1.0F, exponent - 127);
        ASSERT_EQ(power_of_two<float>(exponent), expected);
        ASSERT_EQ(power_of_two<double>(exponent), expected);
        ASSERT_EQ(lane(power_of_two<Lanes>(LanesI(exponent)), lane_count - 1), expected);
    }
    for (const int32_t i : {0, 1, -1, 12345, 1 << 24, -(1 << 24)}) {
        EXPECT_EQ(from_int<float>(i), static_cast<float>(i));
        EXPECT_EQ(from_int<double>(i), i);
        EXPECT_EQ(lane(from_int<Lanes>(LanesI(i)), 0), static_cast<float>(i));
    }
    for (const float x : {-3.0F, 0.25F, 8.0F}) {
        const float inside = x < -1.0F ? -1.0F : x > 2.0F ? 2.0F : x;
        EXPECT_EQ(clamp(x, -1.0F, 2.0F), inside);
        EXPECT_EQ(lane(clamp(Lanes(x), Lanes(-1.0F), Lanes(2.0F)), 0), inside);
        EXPECT_EQ(square(x), x * x);
        EXPECT_EQ(lane(lerp(Lanes(x), Lanes(1.0F), Lanes(0.5F)), 0), 0.5F * (x + 1.0F));
        EXPECT_EQ(lerp(x, 1.0F, 0.0F), x);
    }
}

}  // namespace
}  // namespace obscura
