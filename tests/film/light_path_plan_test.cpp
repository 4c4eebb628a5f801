// tests/film/light_path_plan_test.cpp - light layers: what their headers say, labels that exist.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_path_plan.h"

#include "film/light_components.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

namespace obscura::test {
namespace {

TEST(LightPathPlans, HeadersOfLightGroupsNameTheGroup) {
    const std::vector<std::string> names = {"key", "rest"};
    const std::vector<Layer> layers = light_group_layers(names, true);
    ASSERT_EQ(layers.size(), 2 * (1 + light_components().size()));
    const auto shown = [&](const std::string& layer) {
        for (const Layer& one : layers) {
            if (one.name == layer) return std::get<LightLayer>(one.source).shown;
        }
        return std::string();
    };
    EXPECT_EQ(shown("light_key"), "C.*<[LOB]'key'>");
    EXPECT_EQ(shown("emission_rest"), "C<O'rest'>");
    EXPECT_EQ(shown("background_key"), "C<[LB]'key'>");
    for (const Layer& layer : layers)
        EXPECT_TRUE(parse_light_path_expression(std::get<LightLayer>(layer.source).shown));
}

TEST(LightPathPlans, LabelsThatNothingHasAreRefused) {
    Scene scene;
    scene.materials.resize(1);
    LightGroups groups = make_light_groups(scene, {}).value();
    const auto message = [&](const std::string& expression) {
        const std::vector<Layer> layers = {light_layer_of("x=" + expression).value()};
        const auto plan = LightPathPlan::make(layers, scene, groups, {});
        return plan ? "" : plan.error().message;
    };
    EXPECT_EQ(message("C<RG'coat'>[LOB]"), "");
    EXPECT_EQ(message("C<.D'diff*'>*[LOB]"), "");
    EXPECT_EQ(message("CD*<L'key'>").find("column 4: no lobe or light group fits 'key'; "), 0U);
    EXPECT_NE(message("C[^<R'cloth'>LOB]*[LOB]"), "");
    EXPECT_NE(message("C<R['coat' 'cloth']>[LOB]"), "");
    groups.names = {"key", "rest"};
    EXPECT_EQ(message("CD*<L'key'>"), "");
    EXPECT_NE(message("CD*<L'fill'>"), "");
}

}  // namespace
}  // namespace obscura::test
