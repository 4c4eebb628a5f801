// tests/accel/memory_test.cpp - a BVH that does not fit in the budget is an error, not a crash.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/accel_scenes.h"
#include "base/memory_budget.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura {
namespace {

using namespace test;

/// A grid of squares.
Scene many_squares(int side) {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const Vec3f corner{static_cast<float>(x), static_cast<float>(y), 0};
            builder.quad(corner, {1, 0, 0}, {0, 1, 0}, material);
        }
    }
    return builder.take();
}

TEST(AccelMemory, ABuildThatDoesNotFitIsAnError) {
    const Scene scene = many_squares(200);
    set_memory_limit(program_memory_bytes + (1U << 20), "a test");
    const Result<Accel> refused = Accel::build(scene, "");
    remove_memory_limit();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ExitCode::out_of_memory);
    EXPECT_EQ(refused.error().id, "E-MEM");
    EXPECT_THAT(refused.error().message, testing::HasSubstr("the BVH would take"));
    const Result<Accel> built = Accel::build(scene, "");
    ASSERT_TRUE(built);
    EXPECT_GT(built->memory_bytes(), 1U << 20);
}

}  // namespace
}  // namespace obscura
