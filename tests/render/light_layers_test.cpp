// tests/render/light_layers_test.cpp - shares of the light: they add up, and know lobes and lights.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_components.h"
#include "film/light_path_plan.h"
#include "surface/lobe_shares.h"

#include <gtest/gtest.h>

#include "support/bsdf_albedo.h"
#include "support/splat_scenes.h"
#include "support/thin_wall_scenes.h"
#include "truth/dielectric_scene.h"
#include <cstring>
#include <functional>

namespace obscura::test {
namespace {

constexpr int room_side = 32;

RenderOptions light_options(std::vector<Layer> layers, int samples = 32) {
    RenderOptions options;
    options.width = room_side;
    options.height = room_side;
    options.samples_per_pixel = samples;
    options.layers = std::move(layers);
    return options;
}

std::vector<Layer> components() {
    std::vector<std::string> names;
    for (const LightComponent& component : light_components())
        names.emplace_back(component.name);
    return layers_of(names, 6).value();
}

Camera room_camera() {
    return look_at({0, 0.6f, 3}, {0, 0.2f, 0}, 0.7f, room_side, room_side);
}

const FilmLayer& layer_of(const RenderResult& result, std::string_view name) {
    for (const FilmLayer& one : result.film.layers) {
        if (one.layer.name == name) return one;
    }
    throw std::runtime_error("no layer " + std::string(name));
}

double mean_of(const RenderResult& result, const std::string& name, size_t channel = 0) {
    const FilmLayer& layer = layer_of(result, name);
    double sum = 0;
    for (size_t i = channel; i < layer.pixels.size(); i += 3)
        sum += static_cast<double>(layer.pixels[i]);
    return sum / (room_side * room_side);
}

/// Every pixel's layers that begin with `prefix` add up to the beauty within rounding.
void expect_sum(const RenderResult& result, const std::function<bool(const Layer&)>& counts) {
    double brightest = 0;
    for (size_t pixel = 0; pixel < size_t{room_side} * room_side; ++pixel) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (const FilmLayer& one : result.film.layers) {
                if (counts(one.layer)) sum += static_cast<double>(one.pixels[pixel * 3 + c]);
            }
            const auto beauty = static_cast<double>(result.film.pixels[pixel * 4 + c]);
            ASSERT_NEAR(sum, beauty, 1e-5 * beauty + 1e-9) << "pixel " << pixel << ", " << c;
            brightest = std::max(brightest, beauty);
        }
    }
    EXPECT_GT(brightest, 0) << "nothing was lit";
}

bool is_any(const Layer& /*layer*/) {
    return true;
}

MaterialLayers with(const std::function<void(MaterialLayers&)>& change) {
    MaterialLayers layers;
    change(layers);
    return layers;
}

/// A scene with one kind of surface, lit by all kinds of lights.
struct SurfaceCase {
    const char* name;
    Material material;
    MaterialLayers layers;
    const char* expected;  ///< a component that must not be black
};

Material surface(float roughness, float metallic, float base = 0.7f) {
    Material m;
    m.roughness = roughness;
    m.metallic = metallic;
    m.base_color[0] = base;
    m.base_color[1] = 0.5f * base;
    m.base_color[2] = 0.2f * base;
    m.flags = material_double_sided;
    return m;
}

Material flagged(Material m, uint32_t flags, float alpha) {
    m.flags |= flags;
    m.base_color[3] = alpha;
    return m;
}

Material glowing() {
    Material m = surface(0.4f, 0);
    m.emission[0] = 1;
    return m;
}

std::vector<SurfaceCase> surface_cases() {
    const auto coat = [](MaterialLayers& l) { l.clearcoat = 1; };
    const auto rough_coat = [](MaterialLayers& l) {
        l.clearcoat = 0.7f;
        l.clearcoat_roughness = 0.4f;
    };
    const auto sheen = [](MaterialLayers& l) {
        std::fill_n(l.sheen_color, 3, 0.8f);
        l.sheen_roughness = 0.5f;
    };
    const auto all = [&](MaterialLayers& l) {
        rough_coat(l);
        sheen(l);
        l.iridescence = 1;
        l.anisotropy = 0.7f;
        l.transmission = 0.3f;
        l.diffuse_transmission = 0.4f;
    };
    return {{"Diffuse", surface(1, 0), {}, "diffuse_direct"},
            {"Plastic", surface(0.3f, 0), {}, "specular_direct"},
            {"Mirror", surface(0, 1), {}, "specular_indirect"},
            {"Coat", surface(1, 0), with(coat), "coat_direct"},
            {"RoughCoat", surface(1, 0), with(rough_coat), "coat_indirect"},
            {"Sheen", surface(1, 0), with(sheen), "sheen_direct"},
            {"AllLobes", surface(0.5f, 0.2f), with(all), "sheen_indirect"},
            {"Pane", surface(0, 0), glass_layers(), "transmission_indirect"},
            {"RoughPane", surface(0.5f, 0), glass_layers(), "transmission_indirect"},
            {"Leaf",
             surface(1, 0),
             with([](MaterialLayers& l) { l.diffuse_transmission = 1; }),
             "transmission_direct"},
            {"Glowing", glowing(), {}, "emission"},
            {"Unlit", flagged(surface(1, 0), material_unlit, 1), {}, "emission"},
            {"Blended", flagged(surface(1, 0), material_alpha_blend, 0.5f), {}, "diffuse_indirect"},
            {"CutOut", flagged(surface(1, 0), material_alpha_mask, 0.2f), {}, "diffuse_direct"}};
}

class EverySurface : public testing::TestWithParam<SurfaceCase> {};

/// A ball of the material between a floor and a back wall, a lamp, a spot, a sun, a glowing panel
/// and a sky.
Scene lit_room(const SurfaceCase& one) {
    ThinWallScene room;
    const int32_t index = room.add(one.material, one.layers);
    room.builder.sphere({0, 0.4f, 0}, 0.4f, 24, index);
    room.builder.quad({-2, -1, -2}, {4, 0, 0}, {0, 4, 0}, room.builder.material(surface(0.8f, 0)));
    Material panel = surface(1, 0);
    std::fill_n(panel.emission, 3, 3.0f);
    room.builder.quad({-1.2f, 0, 0}, {0, 1, 0}, {0, 0, 0.5f}, room.builder.material(panel));
    room.light(lamp_at({0.6f, 1.6f, 1.2f}));
    room.light(slanting_sun());
    PunctualLight spot = lamp_at({-0.8f, 1.7f, 1});
    spot.type = static_cast<int32_t>(PunctualType::spot);
    spot.direction[0] = 0.4f;
    spot.direction[1] = -0.8f;
    spot.direction[2] = -0.4f;
    spot.spot_scale = 4;
    spot.spot_on_axis = 2;
    room.light(spot);
    return room.take();
}

TEST_P(EverySurface, ComponentsAddUpToTheBeauty) {
    const RenderResult result = render_scene(lit_room(GetParam()),
                                             {constant_environment(0.3f)},
                                             room_camera(),
                                             light_options(components()));
    expect_sum(result, is_any);
    EXPECT_GT(mean_of(result, GetParam().expected), 1e-4);
    EXPECT_GT(mean_of(result, "background"), 1e-4);
    EXPECT_EQ(mean_of(result, "volume"), 0);
}

TEST_P(EverySurface, ComponentsAddUpWithOptionsAgainstFireflies) {
    for (const bool caustics : {false, true}) {
        RenderOptions options = light_options(components(), 8);
        options.clamp_direct = 0.5;
        options.clamp_indirect = 0.05;
        options.caustics = caustics;
        options.regularize = true;
        const RenderResult result = render_scene(
            lit_room(GetParam()), {constant_environment(0.3f)}, room_camera(), options);
        expect_sum(result, is_any);
    }
}

TEST_P(EverySurface, BeautyKeepsItsBits) {
    const auto render = [&](std::vector<Layer> layers) {
        return render_scene(lit_room(GetParam()),
                            {constant_environment(0.3f)},
                            room_camera(),
                            light_options(std::move(layers), 4));
    };
    const RenderResult without = render({});
    const RenderResult with_layers = render(components());
    ASSERT_EQ(without.film.pixels.size(), with_layers.film.pixels.size());
    EXPECT_EQ(std::memcmp(without.film.pixels.data(),
                          with_layers.film.pixels.data(),
                          without.film.pixels.size() * sizeof(float)),
              0);
}

INSTANTIATE_TEST_SUITE_P(LightLayers,
                         EverySurface,
                         testing::ValuesIn(surface_cases()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(LightLayers, AddUpInAndAroundScatteringMedia) {
    const auto expect_parts = [](float ior, bool inside) {
        DielectricScene dielectrics;
        MaterialLayers cloud = dielectric(ior, {0.8f, 1.2f, 2.0f});
        std::fill_n(cloud.scatter_albedo, 3, 0.9f);
        dielectrics.builder.sphere({0, 0, 0}, 1, 48, dielectrics.add(cloud));
        Scene scene = dielectrics.take();
        scene.lights = {lamp_at({2, 2, 2}), slanting_sun()};
        const Camera camera =
            look_at({0, 0, inside ? 0.5f : 3}, {0, 0, 0}, 0.7f, room_side, room_side);
        const RenderResult result = render_scene(
            std::move(scene), {constant_environment(1)}, camera, light_options(components()));
        expect_sum(result, is_any);
        EXPECT_GT(mean_of(result, inside ? "volume" : "subsurface"), 0.05);
        EXPECT_EQ(mean_of(result, inside ? "subsurface" : "volume"), 0);
    };
    for (const float ior : {1.0f, 1.3f}) {  // the boundary of the first one does not refract
        for (const bool inside : {false, true}) {
            SCOPED_TRACE(testing::Message() << ior << ", " << inside);
            expect_parts(ior, inside);
        }
    }
}

TEST(LightLayers, SplatsAreEmissionBeforeABackground) {
    Scene scene = lit_room(surface_cases()[0]);
    add_splats(scene,
               {{.world_from_ball = ball({0, 0.5, 1}, 0.15),
                 .opacity = 0.7f,
                 .color = {0.9f, 0.2f, 0.1f}}});
    RenderOptions options = light_options(components());
    options.background = BackgroundKind::color;
    std::fill_n(options.background_color, 3, 0.5f);
    const RenderResult result =
        render_scene(std::move(scene), {constant_environment(0.3f)}, room_camera(), options);
    expect_sum(result, is_any);
    EXPECT_GT(mean_of(result, "emission"), 1e-3);
}

/// A white Lambert floor under one lamp: closed forms of the components.
TEST(LightLayers, KnowDirectFromIndirectLight) {
    ThinWallScene scene;
    scene.light(lamp_at({0, 1, 0}));
    const Camera down = look_at({0, 2, 0}, {0, 0, 0}, 0.5f, room_side, room_side);
    const RenderResult result = render_scene(scene.take(), {}, down, light_options(components()));
    expect_sum(result, is_any);
    EXPECT_GT(mean_of(result, "diffuse_direct"), 1);
    for (const char* black : {"diffuse_indirect", "specular_indirect", "coat_direct", "emission"})
        EXPECT_EQ(mean_of(result, black), 0) << black;
    // Below a thin pane, the lamp's light is direct still: it goes straight on.
    ThinWallScene covered;
    covered.light(lamp_at({0, 1, 0}));
    covered.pane(0.5f, covered.add(glass_material(), glass_layers()));
    const RenderResult below =
        render_scene(covered.take(),
                     {},
                     look_at({0, 0.4f, 0.8f}, {0, 0, 0}, 0.5f, room_side, room_side),
                     light_options(components()));
    expect_sum(below, is_any);
    EXPECT_GT(mean_of(below, "diffuse_direct"), 1);
    EXPECT_LT(mean_of(below, "diffuse_indirect"), 0.1 * mean_of(below, "diffuse_direct"));
}

/// Plastic in the sun: the diffuse part is what the facets leave, by their albedo.
TEST(LightLayers, DiffuseAndSpecularAreThoseOfTheFormula) {
    constexpr double sun_lux = 10;
    const Vec3f target{0, 0.1f, 0};
    const Vec3f eye{-0.5f, 0.9f, 0.2f};
    const Vec3d to_eye = normalize(Vec3d{-0.5, 0.8, 0.2});
    const Vec3d wo{to_eye.x, to_eye.z, to_eye.y};  // the normal is y in the world
    const Vec3d wi{0.6, 0, 0.8};
    for (const float roughness : {0.2f, 0.6f}) {
        ThinWallScene scene;
        scene.light(slanting_sun());
        const int32_t plastic = scene.builder.material(surface(roughness, 0));
        scene.builder.quad({-1, target.y, 1}, {2, 0, 0}, {0, 0, -2}, plastic);
        const RenderResult result = render_scene(scene.take(),
                                                 {},
                                                 look_at(eye, target, 1e-4f, room_side, room_side),
                                                 light_options(components(), 1));
        const double leaves =
            1 -
            quadrature_albedo(bsdf_of({0, 0, 0}, 0, static_cast<double>(roughness)), wo).albedo.x;
        const double base[] = {0.7, 0.35, 0.14};
        const BsdfParams<double> p =
            bsdf_of({base[0], base[1], base[2]}, 0, static_cast<double>(roughness));
        const Vec3d all = evaluate_bsdf(p, lobe_weights(p, wo.z), wo, wi).value_cos * sun_lux;
        const double totals[] = {all.x, all.y, all.z};
        for (size_t c = 0; c < 3; ++c) {
            const double diffuse = base[c] * leaves / pi_d * wi.z * sun_lux;
            EXPECT_NEAR(mean_of(result, "diffuse_direct", c), diffuse, 2e-3 * diffuse) << c;
            const double specular = totals[c] - diffuse;
            EXPECT_GT(specular, 0.02);
            EXPECT_NEAR(mean_of(result, "specular_direct", c), specular, 5e-3 * totals[c]) << c;
        }
    }
}

LightGroupOptions three_groups() {
    return {{{"key", {"Key*"}}, {"glow", {"panel"}}, {"sky", {"env"}}}, false, false};
}

/// A room whose lights have names, each group as bright as `strength` says: key, panel, sky, rest.
RenderResult render_groups(const std::array<float, 4>& strength, const RenderOptions& options) {
    Scene scene = lit_room(surface_cases()[1]);
    scene.info.light_names = {"Key lamp", "Sun", "Key spot"};
    scene.material_names = {"floor", "ball", "wall", "panel"};
    scene.material_numbers = {0, 1, 2, 3};
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const float factor = strength[i == 1 ? 3 : 0];
        for (float& channel : scene.lights[i].intensity)
            channel *= factor;
    }
    for (float& channel : scene.materials[3].emission)
        channel *= strength[1];
    return render_scene(
        std::move(scene), {constant_environment(0.3f * strength[2])}, room_camera(), options);
}

TEST(LightGroups, MixedAnewTheyAreTheImageUnderOtherLights) {
    const LightGroupOptions groups = three_groups();
    RenderOptions options =
        light_options(light_group_layers(names_of_groups(groups), groups.components), 256);
    options.light_groups = groups;
    const RenderResult result = render_groups({1, 1, 1, 1}, options);
    expect_sum(result, is_any);
    const std::array<float, 4> strength = {0.25f, 2, 0.5f, 1.5f};
    const RenderResult other = render_groups(strength, light_options({}, 256));
    double difference = 0;
    double sum = 0;
    const char* names[] = {"light_key", "light_glow", "light_sky", "light_rest"};
    for (size_t pixel = 0; pixel < size_t{room_side} * room_side; ++pixel) {
        double mixed = 0;
        for (size_t k = 0; k < 4; ++k) {
            mixed += static_cast<double>(layer_of(result, names[k]).pixels[pixel * 3]) *
                     static_cast<double>(strength[k]);
        }
        const auto direct = static_cast<double>(other.film.pixels[pixel * 4]);
        difference += mixed - direct;
        sum += direct;
    }
    EXPECT_NEAR(difference / sum, 0, 0.01);
    for (const char* name : names)
        EXPECT_GT(mean_of(result, name), 1e-3) << name;
}

TEST(LightGroups, EachAndTheirComponentsAddUp) {
    RenderOptions options = light_options({});
    options.light_groups = {{}, true, true};
    const RenderResult result = render_groups({1, 1, 1, 1}, options);
    expect_sum(result, [](const Layer& one) { return one.name.starts_with("light_"); });
    expect_sum(result, [](const Layer& one) { return !one.name.starts_with("light_"); });
    EXPECT_GT(mean_of(result, "light_Key_lamp"), 0);
    EXPECT_GT(mean_of(result, "light_panel"), 0);
    EXPECT_GT(mean_of(result, "diffuse_direct_Sun"), 0);
    EXPECT_GT(mean_of(result, "light_env"), 0);
    EXPECT_EQ(mean_of(result, "light_rest"), 0);
}

TEST(LightGroups, RefuseWhatNothingFits) {
    const Scene scene = lit_room(surface_cases()[0]);
    const auto error = [&](const LightGroupOptions& options) {
        const auto groups = make_light_groups(scene, options);
        return groups ? std::string() : groups.error().id;
    };
    EXPECT_EQ(error({{{"key", {"Nobody"}}}, false, false}), "E-LIGHT-GROUP-UNKNOWN");
    EXPECT_EQ(error({{{"key", {"*"}}, {"key", {"*"}}}, false, false}), "E-LIGHT-GROUP");
    EXPECT_EQ(error({{{"rest", {"*"}}}, false, false}), "E-LIGHT-GROUP");
    EXPECT_EQ(error({{{"sky", {"env"}}}, false, false}), "");
    for (const char* text : {"key", "key=", "=a", "a.b=c", ""})
        EXPECT_EQ(parse_light_group(text).error().id, "E-LIGHT-GROUP") << text;
    EXPECT_EQ(parse_light_group("key=Key*,Sun").value().patterns.size(), 2u);
}

TEST(LightPathExpressions, AreLayersOfTheirOwn) {
    std::vector<Layer> layers = components();
    const auto add = [&](const char* text) { layers.push_back(light_layer_of(text).value()); };
    add("everything=C.*[LOB]");
    add("gloss_of_key=C<R[GS]>+<L'key'>");
    add("key=C.*<L'key'>");
    add("none=C<TD'coat'>.*[LOB]");
    add("second=C<RD>D[LOB]");
    RenderOptions options = light_options(layers);
    options.light_groups = three_groups();
    const RenderResult result = render_groups({1, 1, 1, 1}, options);
    expect_sum(result, [](const Layer& one) { return one.name == "everything"; });
    EXPECT_GT(mean_of(result, "gloss_of_key"), 0);
    EXPECT_LT(mean_of(result, "gloss_of_key"), mean_of(result, "key"));
    EXPECT_LT(mean_of(result, "key"), mean_of(result, "everything"));
    EXPECT_EQ(mean_of(result, "none"), 0);
    EXPECT_GT(mean_of(result, "second"), 0);
    EXPECT_LT(mean_of(result, "second"), mean_of(result, "diffuse_indirect"));
    for (const char* text : {"a b=C.*L", "C.*L", "half_1=C.*L"})
        EXPECT_EQ(light_layer_of(text).error().id, "E-LAYER-NAME") << text;
    EXPECT_EQ(light_layer_of("a=C.*").error().id, "E-LPE");
}

/// Light that a pane sends back does not become light from behind it when the path that met it goes
/// straight on.
TEST(LightPathExpressions, WhatAPaneReflectsDidNotComeThroughIt) {
    std::vector<Layer> layers;
    for (const char* text : {"turned=C.[^<TS'straight'>LOB].*[LOB]",
                             "passed=C.<TS'straight'>.*[LOB]",
                             "direct=C.[LOB]"})
        layers.push_back(light_layer_of(text).value());
    ThinWallScene scene;
    scene.light(lamp_at({0, 0.25f, 0}));
    scene.pane(0.5f, scene.add(glass_material(), glass_layers(0.5f)));  // half of it is diffuse
    const Camera camera = look_at({0, 0.4f, 0.8f}, {0, 0, 0}, 0.5f, room_side, room_side);
    const RenderResult result = render_scene(scene.take(), {}, camera, light_options(layers));
    expect_sum(result, is_any);
    EXPECT_GT(mean_of(result, "turned"), 0.1 * mean_of(result, "direct"));
    EXPECT_EQ(mean_of(result, "passed"), 0) << "above the pane it is dark";
}

TEST(LightLayers, DoNotDependOnTilesAndCrops) {
    RenderOptions options = light_options(components(), 40);
    const RenderResult whole = render_groups({1, 1, 1, 1}, options);
    options.tile_size = 7;
    options.crop = PixelRect{5, 3, 21, 17};
    const RenderResult part = render_groups({1, 1, 1, 1}, options);
    for (const FilmLayer& one : part.film.layers) {
        const FilmLayer& other = layer_of(whole, one.layer.name);
        for (size_t y = 0; y < 17; ++y) {
            const float* row = other.pixels.data() + ((y + 3) * room_side + 5) * 3;
            ASSERT_EQ(std::memcmp(one.pixels.data() + y * 21 * 3, row, 21 * 3 * sizeof(float)), 0)
                << one.layer.name;
        }
    }
}

/// Half of the floor lies in the shadow of a screen between it and the sun.
TEST(ShadowLayer, IsTheFractionOfDirectLightThatArrives) {
    ThinWallScene scene;
    PunctualLight sun = slanting_sun();
    std::fill_n(sun.direction, 3, 0.0f);
    sun.direction[1] = -1;
    scene.light(sun);
    scene.builder.quad({-5, 1, 5}, {5, 0, 0}, {0, 0, -10}, scene.builder.material(surface(1, 0)));
    Camera below = look_at({0, 0.9f, 0}, {0, 0, 0}, 0.8f, room_side, room_side);
    const RenderResult result =
        render_scene(scene.take(),
                     {},
                     below,
                     light_options(layers_of(std::vector<std::string>{"shadow"}, 6).value()));
    const FilmLayer& shadow = layer_of(result, "shadow");
    int lit = 0;
    int dark = 0;
    for (size_t i = 0; i < shadow.pixels.size(); i += 3) {
        lit += shadow.pixels[i] == 1;
        dark += shadow.pixels[i] == 0;
    }
    EXPECT_GT(lit, room_side * room_side * 4 / 10);
    EXPECT_GT(dark, room_side * room_side * 4 / 10);
}

/// The names in the documentation are a partition of all paths of up to four scatterings.
TEST(LightComponents, ArePartsThatEveryPathHasOneOf) {
    Scene scene;
    scene.materials.resize(1);
    const LightGroups groups = make_light_groups(scene, {}).value();
    const auto plan = LightPathPlan::make(components(), scene, groups, {0});
    ASSERT_TRUE(plan) << plan.error().message;
    const LightPathTable table = plan->table();
    std::function<void(size_t, int)> visit = [&](size_t state, int depth) {
        for (size_t light = 0; light < light_kinds; ++light) {
            const size_t row = state * table.class_count + light;
            EXPECT_EQ(table.layer_begin[row + 1] - table.layer_begin[row], 1u);
        }
        if (depth == 4) return;
        for (size_t event = 0; event < scatter_event_count; ++event)
            visit(table.next[state * scatter_event_count + event], depth + 1);
    };
    visit(0, 0);
    EXPECT_LE(table.state_count, 16);
    EXPECT_EQ(table.sum_count, 1) << "settled paths know no kinds of light";
}

}  // namespace
}  // namespace obscura::test
