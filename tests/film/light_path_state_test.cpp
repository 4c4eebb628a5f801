// tests/film/light_path_state_test.cpp - light is shared out by the weights with which it arrived.
// SPDX-License-Identifier: Apache-2.0
#include "stages/light_path_state.h"

#include "film/light_components.h"
#include "film/light_path_plan.h"
#include "surface/lobe_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace obscura::test {
namespace {

constexpr size_t diffuse_event = Lobes::index<Diffuse>();
constexpr size_t specular_event = Lobes::index<FacetReflection>();

/// A batch of one path for all components, which has scattered by two lobes: a quarter diffuse.
class LightPathStates : public ::testing::Test {
protected:
    void SetUp() override {
        std::vector<std::string> names;
        for (const LightComponent& component : light_components())
            names.emplace_back(component.name);
        Scene scene;
        scene.materials.resize(1);
        const std::vector<Layer> layers = layers_of(names, 6).value();
        plan_ = LightPathPlan::make(layers, scene, make_light_groups(scene, {}).value(), {0});
        ASSERT_TRUE(plan_) << plan_.error().message;
        table_ = plan_->table();
        state_.begin(table_, 1, true, true);
    }

    uint16_t after(size_t event) const { return table_.next[event]; }

    void scatter(const ColorColumns& weights) {
        add_color(weights, after(diffuse_event), 0, {0.25f, 0.25f, 0.25f});
        add_color(weights, after(specular_event), 0, {0.75f, 0.75f, 0.75f});
    }

    void scatter_path() {
        const LightPathColumns& columns = state_.columns();
        clear_color(columns.weights, 0, 0);
        scatter(columns.weights);
        columns.progress[0] = path_settles_next;
        add_to(columns.resting_sums);
    }

    void scatter_shadow() {
        const LightPathColumns& columns = state_.columns();
        scatter(columns.shadow_weights);
        columns.shadow_split[0] = 1;
        add_to(columns.shadow_sums);
    }

    /// Light of brightness 4 arrives.
    void add_to(const ColorColumns& sums) const {
        const uint32_t light_class = background_class(table_);
        const uint16_t sum = table_.resting_sum_of_class[light_class];
        ASSERT_NE(sum, no_light_sum);
        add_color(sums, sum, 0, {4, 4, 4});
    }

    size_t number_of(std::string_view name) const {
        const auto all = light_components();
        const auto found = std::find_if(
            all.begin(), all.end(), [&](const LightComponent& one) { return one.name == name; });
        return static_cast<size_t>(found - all.begin());
    }

    static float red(const ColorView& color) { return color.r == nullptr ? 0.0f : color.r[0]; }
    float layer(std::string_view name) const { return red(state_.layer(number_of(name))); }
    float behind(std::string_view name) const { return red(state_.behind(number_of(name))); }

    void finish() {
        float zero = 0;
        state_.finish({&zero, &zero, &zero, &zero});
    }

    /// Each lobe's part of the light is in the layer of its direct light, and nowhere else.
    void expect_direct(float light) {
        EXPECT_EQ(layer("diffuse_direct"), 0.25f * light);
        EXPECT_EQ(layer("specular_direct"), 0.75f * light);
        for (const LightComponent& one : light_components()) {
            const std::string name = one.name;
            if (name == "diffuse_direct" || name == "specular_direct") continue;
            EXPECT_EQ(layer(name), 0.0f) << name;
        }
    }

    Result<LightPathPlan> plan_ = fail(Error{});
    LightPathTable table_;
    LightPathState state_;
};

TEST_F(LightPathStates, LightAtRestingPathsGoesByTheirWeights) {
    scatter_path();
    scatter_shadow();
    finish();
    expect_direct(8);
}

TEST_F(LightPathStates, WhatArrivedBeforeAPathMovesGoesByItsWeightsThen) {
    scatter_path();
    state_.move_path(0, volume_event);
    finish();
    expect_direct(4);
}

TEST_F(LightPathStates, WhatArrivedBeforeAShadowRayMovesGoesByItsWeightsThen) {
    scatter_shadow();
    state_.move_shadow(0, volume_event);
    finish();
    expect_direct(4);
}

TEST_F(LightPathStates, TheNextBounceForgetsWeightsOfShadowsNotTheirLight) {
    scatter_shadow();
    state_.begin_bounce();
    EXPECT_EQ(state_.columns().shadow_split[0], 0u);
    finish();
    expect_direct(4);
}

TEST_F(LightPathStates, LightAtRestGoesBehindCatchersWithTheRest) {
    scatter_path();
    scatter_shadow();
    state_.move_behind(0);
    EXPECT_EQ(behind("diffuse_direct"), 2.0f);
    EXPECT_EQ(behind("specular_direct"), 6.0f);
    finish();
    expect_direct(0);
}

TEST_F(LightPathStates, SamplesThatAreThrownAwayLeaveNothingInLayers) {
    constexpr uint32_t samples = 4;
    state_.begin(table_, samples, true, true);
    for (uint32_t slot = 0; slot < samples; ++slot)
        state_.add_path_light(slot, background_class(table_), {4, 4, 4});
    std::array<float, samples> red = {4, std::numeric_limits<float>::quiet_NaN(), 4, 2e30f};
    std::array<float, samples> rest = {4, 4, 4, 4};
    state_.finish({red.data(), rest.data(), rest.data(), rest.data()});
    const ColorView background = state_.layer(number_of("background"));
    ASSERT_NE(background.r, nullptr);
    const std::array<float, samples> left = {4, 0, 4, 0};
    for (size_t slot = 0; slot < samples; ++slot) {
        EXPECT_EQ(background.r[slot], left[slot]) << slot;
        EXPECT_EQ(background.b[slot], left[slot]) << slot;
    }
}

}  // namespace
}  // namespace obscura::test
