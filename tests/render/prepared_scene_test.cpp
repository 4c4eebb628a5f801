// tests/render/prepared_scene_test.cpp - an instruction set that the CPU lacks is refused.
// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::test {
namespace {

TEST(PreparedScene, AnInstructionSetThatTheProcessorLacksIsRefused) {
    const auto no_processor_has_it = static_cast<Isa>(99);
    SceneBuilder builder;
    builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material({}));
    Log log(Verbosity::quiet);
    const auto prepared = PreparedScene::create(builder.take(), {}, no_processor_has_it, log);
    ASSERT_FALSE(prepared);
    EXPECT_EQ(prepared.error().id, "E-ISA");
    EXPECT_EQ(prepared.error().code, ExitCode::unsupported);
}

}  // namespace
}  // namespace obscura::test
