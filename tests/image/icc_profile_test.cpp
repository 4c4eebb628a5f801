// tests/image/icc_profile_test.cpp - the profile of sRGB read back, against published numbers.
// SPDX-License-Identifier: Apache-2.0
#include "image/icc_profile.h"

#include "image/output_tags.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

using namespace testing_images;

TEST(IccProfile, TheHeaderIsThatOfADisplay) {
    const ByteVector profile = srgb_icc_profile();
    EXPECT_EQ(big_endian(profile, 0, 4), profile.size());
    EXPECT_LT(profile.size(), 1000U);
    EXPECT_EQ(profile.size() % 4, 0U);
    EXPECT_EQ(big_endian(profile, 8, 4), 0x04200000U) << "version 4.2";
    EXPECT_EQ(text_at(profile, 12, 12), "mntrRGB XYZ ");
    EXPECT_EQ(text_at(profile, 36, 4), "acsp");
    const uint32_t month = big_endian(profile, 26, 2);
    const uint32_t day = big_endian(profile, 28, 2);
    EXPECT_TRUE(month >= 1 && month <= 12 && day >= 1 && day <= 31);
    EXPECT_EQ(big_endian(profile, 68, 4), 0xF6D6U) << "D50 as the specification spells it";
    EXPECT_EQ(big_endian(profile, 72, 4), 0x10000U);
    EXPECT_EQ(big_endian(profile, 76, 4), 0xD32DU);
    for (size_t at = 100; at < 128; ++at)
        EXPECT_EQ(profile[at], std::byte{0}) << "reserved";
}

TEST(IccProfile, EveryTagLiesWithinOnABoundary) {
    const ByteVector profile = srgb_icc_profile();
    const uint32_t tags = big_endian(profile, 128, 4);
    ASSERT_EQ(tags, 10U);
    for (uint32_t i = 0; i < tags; ++i) {
        const uint32_t offset = big_endian(profile, 132 + 12 * i + 4, 4);
        const uint32_t size = big_endian(profile, 132 + 12 * i + 8, 4);
        EXPECT_EQ(offset % 4, 0U);
        EXPECT_GE(offset, 132 + 12 * tags);
        EXPECT_LE(offset + size, profile.size());
    }
    const auto elements = profile_elements(profile);
    EXPECT_EQ(elements.size(), tags);
    for (const char* text : {"desc", "cprt"}) {
        const ByteVector& element = elements.at(text);
        EXPECT_EQ(text_at(element, 0, 4), "mluc");
        EXPECT_EQ(big_endian(element, 24, 4) + big_endian(element, 20, 4), element.size());
    }
    EXPECT_EQ(text_at(elements.at("desc"), 28, 8), std::string("\0s\0R\0G\0B", 8));
}

/// Truth: the columns of sRGB adapted to D50 and the Bradford matrix, as Lindbloom publishes them:
/// for whites that differ from those of the specifications by up to 3e-4 in Z.
TEST(IccProfile, ColumnsAndAdaptationAreThePublishedOnes) {
    const auto elements = profile_elements(srgb_icc_profile());
    const double columns[3][3] = {{0.4360747, 0.2225045, 0.0139322},
                                  {0.3850649, 0.7168786, 0.0971045},
                                  {0.1430804, 0.0606169, 0.7141733}};
    double white[3] = {};
    for (size_t c = 0; c < 3; ++c) {
        const char* const names[] = {"rXYZ", "gXYZ", "bXYZ"};
        const ByteVector& element = elements.at(names[c]);
        EXPECT_EQ(text_at(element, 0, 4), "XYZ ");
        const std::vector<double> found = fixed_numbers(element);
        ASSERT_EQ(found.size(), 3U);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(found[i], columns[c][i], 3e-4) << names[c];
            white[i] += found[i];
        }
    }
    const double d50[3] = {0.9642, 1, 0.8249};
    for (size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(white[i], d50[i], 4.0 / 65536) << "equal codes are the white";
    const double adaptation[9] = {1.0478112,
                                  0.0228866,
                                  -0.0501270,
                                  0.0295424,
                                  0.9904844,
                                  -0.0170491,
                                  -0.0092345,
                                  0.0150436,
                                  0.7521316};
    const std::vector<double> found = fixed_numbers(elements.at("chad"));
    ASSERT_EQ(found.size(), 9U);
    for (size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(found[i], adaptation[i], 5e-4) << i;
}

/// Truth: light of some codes, from a published table of the sRGB curve.
TEST(IccProfile, TheCurveIsThatOfSrgb) {
    const auto elements = profile_elements(srgb_icc_profile());
    EXPECT_EQ(elements.at("rTRC"), elements.at("gTRC"));
    EXPECT_EQ(elements.at("rTRC"), elements.at("bTRC"));
    const ByteVector& curve = elements.at("rTRC");
    EXPECT_EQ(text_at(curve, 0, 4), "para");
    EXPECT_EQ(big_endian(curve, 8, 2), 3U);
    const std::vector<double> p = fixed_numbers(curve, 12);
    ASSERT_EQ(p.size(), 5U);
    const auto light = [&](double code) {
        const double x = code / 255;
        return x >= p[4] ? std::pow(p[1] * x + p[2], p[0]) : p[3] * x;
    };
    EXPECT_NEAR(light(0), 0, 1e-6);
    EXPECT_NEAR(light(10), 0.0030353, 2e-5);
    EXPECT_NEAR(light(11), 0.0033465, 2e-5);
    EXPECT_NEAR(light(64), 0.0512695, 2e-5);
    EXPECT_NEAR(light(128), 0.2158605, 2e-5);
    EXPECT_NEAR(light(188), 0.5028865, 2e-5);
    EXPECT_NEAR(light(255), 1, 2e-5);
}

}  // namespace
}  // namespace obscura
