// tests/light/studio_test.cpp - the built-in studio: neutral, moderate, lit from the front left.
// SPDX-License-Identifier: Apache-2.0
#include "light/studio.h"

#include "light/environment_table.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura {
namespace {

TEST(Studio, IsNeutralAndModerate) {
    const std::vector<float> pixels = make_studio_pixels();
    ASSERT_EQ(pixels.size(), static_cast<size_t>(studio_width) * studio_height * 3);
    for (size_t i = 0; i < pixels.size(); i += 3) {
        EXPECT_EQ(pixels[i], pixels[i + 1]);
        EXPECT_EQ(pixels[i], pixels[i + 2]);
        EXPECT_GT(pixels[i], 0.1F);
        EXPECT_LT(pixels[i], 20.0F);
    }
    const EnvironmentTable table =
        EnvironmentTable::create({studio_width, studio_height, pixels.data()}, 1, 0).value();
    EXPECT_EQ(table.repaired_values(), 0);
    const double mean = table.power() / (4 * pi_d);
    EXPECT_GT(mean, 0.5);
    EXPECT_LT(mean, 1.0);
}

TEST(Studio, KeyIsOnTheLeftOfASubjectThatFacesPlusZ) {
    const std::vector<float> pixels = make_studio_pixels();
    const EnvironmentTable table =
        EnvironmentTable::create({studio_width, studio_height, pixels.data()}, 1, 0).value();
    const auto light = [&](double x, double y, double z) {
        return environment_radiance(table.view(), normalize(Vec3d{x, y, z})).x;
    };
    EXPECT_GT(light(-0.85, 0.75, 0.75), 5);                  // key
    EXPECT_GT(light(1, 0.25, 0.55), 2 * light(0, 0.25, 1));  // fill
    EXPECT_GT(light(0.35, 0.6, -1), 3);                      // rim
    EXPECT_GT(light(0, 1, 0), light(0, -1, 0));              // dome over floor
}

}  // namespace
}  // namespace obscura
