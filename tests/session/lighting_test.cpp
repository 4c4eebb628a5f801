// tests/session/lighting_test.cpp - what a request says of its lighting.
// SPDX-License-Identifier: Apache-2.0
#include "session/lighting.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(LoadLighting, TakesWhatTheRequestSays) {
    RenderRequest request;
    Log log(Verbosity::quiet);
    EXPECT_FALSE(load_lighting(request, log)->catcher_ground);
    EXPECT_FALSE(load_lighting(request, log)->environment);
    request.catcher_ground = true;
    request.environment_intensity = 2;
    request.environment_rotation_deg = 30;
    request.environment = "white";
    const auto lighting = load_lighting(request, log);
    ASSERT_TRUE(lighting);
    EXPECT_TRUE(lighting->catcher_ground);
    EXPECT_EQ(lighting->environment_intensity, 2);
    EXPECT_EQ(lighting->environment_rotation_deg, 30);
    EXPECT_TRUE(lighting->environment);
    const auto again = load_lighting(request, log, lighting->environment);
    EXPECT_EQ(again->environment, lighting->environment) << "it is not made once more";
}

}  // namespace
}  // namespace obscura
