// tests/render/catcher_layers_test.cpp - layers of the light and shadow catchers add up, too.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_components.h"
#include "film/light_path_plan.h"

#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"
#include "truth/dielectric_scene.h"
#include <functional>
#include <string_view>

namespace obscura::test {
namespace {

constexpr int catcher_side = 32;

/// A ball and a wall on a floor that is a catcher, before a lamp, a sun and a glowing panel. Below
/// the floor is the catcher `ground`.
Scene catcher_room(Material ball, const MaterialLayers& layers) {
    ThinWallScene room;
    const auto matt = [](float grey) {
        Material m;
        m.metallic = 0;
        m.roughness = 1;
        m.flags = material_double_sided;
        std::fill_n(m.base_color, 3, grey);
        return m;
    };
    room.builder.sphere({0, 0.4f, 0}, 0.4f, 24, room.add(ball, layers));
    room.builder.quad({-2, -0.1f, -1}, {4, 0, 0}, {0, 1, 0}, room.builder.material(matt(0.6f)));
    Material panel = matt(0.5f);
    panel.emission[0] = panel.emission[1] = 3;
    room.builder.quad({-1, 0, 0}, {0, 1, 0}, {0, 0, 0.5f}, room.builder.material(panel));
    room.light(lamp_at({0.6f, 1.6f, 1.2f}));
    room.light(slanting_sun());
    Scene scene = room.take();
    number_media(scene);
    scene.visibility.primitives.assign(scene.primitives.size(), 0);
    scene.visibility.primitives[0] = visibility_catcher;
    return scene;
}

RenderOptions catcher_options(std::vector<Layer> layers, BackgroundKind background) {
    RenderOptions options;
    options.width = options.height = catcher_side;
    options.samples_per_pixel = 32;
    options.layers = std::move(layers);
    options.catcher_ground_m = -0.2f;
    options.catcher_reflections = true;
    options.background = background;
    std::fill_n(options.background_color, 3, 0.4f);
    return options;
}

RenderResult render_room(Scene scene, const RenderOptions& options) {
    const Camera camera = look_at({0, 1.2f, 3}, {0, 0.1f, 0}, 0.9f, catcher_side, catcher_side);
    return render_scene(std::move(scene), {constant_environment(0.3f)}, camera, options);
}

std::vector<Layer> all_components() {
    std::vector<std::string> names;
    for (const LightComponent& component : light_components())
        names.emplace_back(component.name);
    return layers_of(names, 6).value();
}

const UnsetArray<float>& pixels_of(const RenderResult& result, std::string_view name) {
    for (const FilmLayer& one : result.film.layers) {
        if (one.layer.name == name) return one.pixels;
    }
    throw std::runtime_error("no layer " + std::string(name));
}

double sum_of(const RenderResult& result, std::string_view name) {
    double sum = 0;
    for (const float value : pixels_of(result, name))
        sum += static_cast<double>(value);
    return sum;
}

/// In every pixel the layers whose names begin with `light_`, or else the others, are the beauty.
void expect_layers_add_up(const RenderResult& result, bool groups) {
    double brightest = 0;
    for (size_t i = 0; i < size_t{3} * catcher_side * catcher_side; ++i) {
        double sum = 0;
        for (const FilmLayer& one : result.film.layers) {
            if ((one.layer.name.rfind("light_", 0) == 0) == groups)
                sum += static_cast<double>(one.pixels[i]);
        }
        const auto beauty = static_cast<double>(result.film.pixels[i / 3 * 4 + i % 3]);
        ASSERT_NEAR(sum, beauty, 1e-5 * beauty + 1e-9) << i;
        brightest = std::max(brightest, beauty);
    }
    EXPECT_GT(brightest, 0.1);
}

constexpr BackgroundKind backgrounds[] = {
    BackgroundKind::environment, BackgroundKind::transparent, BackgroundKind::color};

struct CatcherCase {
    const char* name;
    Material ball;
    MaterialLayers layers;
};

Material grey_ball(float roughness, uint32_t flags = 0, float alpha = 1) {
    Material m;
    m.metallic = 0;
    m.roughness = roughness;
    m.flags = material_double_sided | flags;
    m.base_color[1] = 0.5f;
    m.base_color[3] = alpha;
    return m;
}

std::vector<CatcherCase> catcher_cases() {
    MaterialLayers coated;
    coated.clearcoat = 1;
    return {{"Plastic", grey_ball(0.3f), {}},
            {"Coat", grey_ball(1), coated},
            {"Pane", grey_ball(0), glass_layers()},
            {"HalfPane", grey_ball(0), glass_layers(0.5f)},
            {"RoughPane", grey_ball(0.5f), glass_layers()},
            {"Solid", grey_ball(0), dielectric(1.5f, {0.2f, 0.5f, 1})},
            {"Air", grey_ball(0), dielectric(1, {0.2f, 0.5f, 1})},
            {"Unlit", grey_ball(1, material_unlit), {}},
            {"Blended", grey_ball(1, material_alpha_blend, 0.5f), {}}};
}

class LayersOverCatchers : public testing::TestWithParam<CatcherCase> {};

TEST_P(LayersOverCatchers, ComponentsAddUp) {
    for (const BackgroundKind background : backgrounds) {
        RenderOptions options = catcher_options(all_components(), background);
        const Scene room = catcher_room(GetParam().ball, GetParam().layers);
        const RenderResult result = render_room(room, options);
        expect_layers_add_up(result, false);
        options.layers.clear();
        const RenderResult beauty = render_room(room, options);
        EXPECT_TRUE(std::equal(
            beauty.film.pixels.begin(), beauty.film.pixels.end(), result.film.pixels.begin()));
    }
}

/// With groups alone there is one state, and the light of all paths is summed at first.
TEST_P(LayersOverCatchers, LightGroupsAddUp) {
    for (const bool with_components : {false, true}) {
        for (const BackgroundKind background : backgrounds) {
            RenderOptions options = catcher_options({}, background);
            options.light_groups.each = true;
            options.light_groups.components = with_components;
            const RenderResult result =
                render_room(catcher_room(GetParam().ball, GetParam().layers), options);
            expect_layers_add_up(result, true);
            if (with_components) expect_layers_add_up(result, false);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(CatcherLayers,
                         LayersOverCatchers,
                         testing::ValuesIn(catcher_cases()),
                         [](const auto& test) { return std::string(test.param.name); });

/// All that a catcher adds over nothing are its reflections, which are gloss.
TEST(CatcherLayers, ReflectionsAreGlossAndShadowsAreNoLight) {
    const auto render = [&](bool reflects) {
        RenderOptions options = catcher_options(all_components(), BackgroundKind::transparent);
        options.layers.push_back(
            light_layer("gloss", parse_light_path_expression("C<RG'specular'>.*[LOB]").value()));
        const std::vector<std::string> ratio = {"shadow"};
        options.layers.push_back(layers_of(ratio, 6).value()[0]);
        options.catcher_reflections = reflects;
        return render_room(catcher_room(grey_ball(1, material_unlit), {}), options);
    };
    const RenderResult with = render(true);
    const RenderResult without = render(false);
    EXPECT_GT(sum_of(with, "gloss"), sum_of(without, "gloss") + 1);
    EXPECT_GT(sum_of(with, "specular_direct"), sum_of(without, "specular_direct"));
    EXPECT_GT(sum_of(with, "specular_indirect"), sum_of(without, "specular_indirect"));
    std::vector<std::string_view> others = {"shadow"};
    for (const LightComponent& component : light_components()) {
        const std::string_view name = component.name;
        if (name != "specular_direct" && name != "specular_indirect") others.push_back(name);
    }
    for (const std::string_view name : others) {
        const UnsetArray<float>& a = pixels_of(with, name);
        const UnsetArray<float>& b = pixels_of(without, name);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << name;
    }
}

/// What lies behind the catcher is seen through two surfaces of the glass ball, never through one.
TEST(CatcherLayers, WhatLiesBehindCountsEverySurface) {
    RenderOptions options = catcher_options({}, BackgroundKind::color);
    options.transparent_glass = TransparentGlass::on;
    const auto add = [&](const char* name, const char* expression) {
        options.layers.push_back(
            light_layer(name, parse_light_path_expression(expression).value()));
    };
    add("one", "C<T.>B");
    add("any", "C.*B");
    const RenderResult result =
        render_room(catcher_room(grey_ball(0), dielectric(1.5f, {1, 1, 1})), options);
    EXPECT_EQ(sum_of(result, "one"), 0);
    EXPECT_GT(sum_of(result, "any"), 1);
}

TEST(CatcherLayers, DoNotDependOnTiles) {
    RenderOptions options = catcher_options(all_components(), BackgroundKind::environment);
    const Scene room = catcher_room(grey_ball(0), dielectric(1.5f, {0.2f, 0.5f, 1}));
    const RenderResult whole = render_room(room, options);
    options.tile_size = 5;
    const RenderResult tiled = render_room(room, options);
    for (const LightComponent& component : light_components()) {
        const UnsetArray<float>& a = pixels_of(whole, component.name);
        const UnsetArray<float>& b = pixels_of(tiled, component.name);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << component.name;
    }
}

}  // namespace
}  // namespace obscura::test
