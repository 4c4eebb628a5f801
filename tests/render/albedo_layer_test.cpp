// tests/render/albedo_layer_test.cpp - the layer `albedo`, against white surroundings and by hand.
// SPDX-License-Identifier: Apache-2.0
#include "film/layers.h"

#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

namespace obscura::test {
namespace {

constexpr int side = 8;

/// A square of 2 m around (0, 0, 3), seen along -Z: parallel, so that all see along the normal.
Camera albedo_camera() {
    Camera camera;
    camera.model = CameraModel::orthographic;
    camera.world_from_camera.m[2][3] = 3;
    camera.orthographic = {1, 1, 2.0f / side};
    return camera;
}

RenderOptions albedo_options(int samples) {
    RenderOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = samples;
    const std::vector<std::string> names = {"albedo"};
    options.layers = layers_of(names, 6).value();
    return options;
}

/// A scene whose materials may have layers.
struct AlbedoScene {
    SceneBuilder builder;
    std::vector<MaterialLayers> layers;

    int32_t add(Material material, const MaterialLayers* extension = nullptr) {
        if (extension != nullptr) {
            material.layers = static_cast<int32_t>(layers.size());
            layers.push_back(*extension);
        }
        return builder.material(material);
    }
    /// Fills the view at this height; `towards` is the direction of its front along Z.
    void wall(float z, int32_t material, float towards = 1) {
        builder.quad({-9 * towards, -9, z}, {18 * towards, 0, 0}, {0, 18, 0}, material);
    }
    Scene take() {
        Scene scene = builder.take();
        scene.layers = layers;
        return scene;
    }
};

Material colored(const Vec3f& color, float roughness, float metallic) {
    Material m;
    m.base_color[0] = color.x;
    m.base_color[1] = color.y;
    m.base_color[2] = color.z;
    m.roughness = roughness;
    m.metallic = metallic;
    m.flags = material_double_sided;
    return m;
}

constexpr Vec3f copper{0.95f, 0.64f, 0.54f};

/// The mean of the layer, or of the beauty, over all pixels.
Vec3f mean_of(const UnsetArray<float>& pixels, size_t channels) {
    double sum[3] = {};
    const size_t count = pixels.size() / channels;
    for (size_t i = 0; i < count; ++i) {
        for (size_t c = 0; c < 3; ++c)
            sum[c] += static_cast<double>(pixels[i * channels + c]) / static_cast<double>(count);
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

Vec3f mean_albedo(const RenderResult& result) {
    return mean_of(result.film.layers.front().pixels, 3);
}

void expect_color(const Vec3f& got, const Vec3f& expected, float slack, const char* what) {
    EXPECT_NEAR(got.x, expected.x, slack) << what;
    EXPECT_NEAR(got.y, expected.y, slack) << what;
    EXPECT_NEAR(got.z, expected.z, slack) << what;
}

struct NamedMaterial {
    const char* name;
    Material core;
    MaterialLayers layers = {};
    bool layered = true;
    float slack = 0.012f;
};

/// One of each kind that is rough.
std::vector<NamedMaterial> rough_materials() {
    const Vec3f leaf{0.2f, 0.6f, 0.1f};
    std::vector<NamedMaterial> out = {{"matte", colored(leaf, 1, 0), {}, false},
                                      {"plastic", colored(leaf, 0.2f, 0), {}, false},
                                      {"polished", colored(leaf, 0, 0), {}, false},
                                      {"black and rough", colored({0, 0, 0}, 0.5f, 0), {}, false},
                                      {"metal", colored(copper, 0.5f, 1), {}, false},
                                      {"half metal", colored(copper, 0.4f, 0.5f), {}, false}};
    const auto add = [&](const char* name, float roughness, auto change) {
        NamedMaterial one{name, colored(leaf, roughness, 0)};
        change(one);
        out.push_back(one);
    };
    add("sheen", 0.7f, [](NamedMaterial& m) {
        std::fill_n(m.layers.sheen_color, 3, 0.8f);
        m.layers.sheen_roughness = 0.5f;
        m.slack = 0.06f;  // what leaves at grazing angles loses more than along the normal
    });
    add("rough coat", 0.6f, [](NamedMaterial& m) {
        m.layers.clearcoat = 1;
        m.layers.clearcoat_roughness = 0.3f;
    });
    add("smooth coat", 0.6f, [](NamedMaterial& m) { m.layers.clearcoat = 1; });
    add("dull and dense", 0.6f, [](NamedMaterial& m) { m.layers.ior = 2.2f; });
    add("tinted highlights", 0.3f, [](NamedMaterial& m) {
        m.layers.ior = 2.2f;
        m.layers.specular_color[0] = 0;
    });
    add("rough pane", 0.5f, [](NamedMaterial& m) { m.layers.transmission = 1; });
    add("half a pane", 0.1f, [](NamedMaterial& m) { m.layers.transmission = 0.5f; });
    add("paper", 0.8f, [](NamedMaterial& m) {
        m.layers.diffuse_transmission = 0.4f;
        m.layers.diffuse_transmission_color[2] = 0.1f;
    });
    add("brushed", 0.3f, [](NamedMaterial& m) {
        m.core.metallic = 1;
        m.layers.anisotropy = 0.7f;
    });
    add("iridescent", 0.3f, [](NamedMaterial& m) { m.layers.iridescence = 1; });
    return out;
}

TEST(AlbedoLayer, IsWhatARoughSurfaceSendsBackOfWhiteSurroundings) {
    for (const NamedMaterial& one : rough_materials()) {
        AlbedoScene scene;
        scene.wall(0, scene.add(one.core, one.layered ? &one.layers : nullptr));
        const RenderResult result = render_scene(
            scene.take(), {constant_environment(1)}, albedo_camera(), albedo_options(1024));
        expect_color(mean_albedo(result), mean_of(result.film.pixels, 4), one.slack, one.name);
    }
}

/// Pixels beside each other are worked out together: a layered material's neighbour without layers
/// must keep its own albedo, and the other way round.
TEST(AlbedoLayer, DoesNotDependOnTheMaterialsNearby) {
    const std::vector<NamedMaterial> materials = rough_materials();
    const NamedMaterial& core = materials.front();
    for (const NamedMaterial& one : materials) {
        if (!one.layered) continue;
        AlbedoScene scene;
        const int32_t left = scene.add(core.core);
        const int32_t right = scene.add(one.core, &one.layers);
        scene.builder.quad({-9, -9, 0}, {8.75f, 0, 0}, {0, 18, 0}, left);
        scene.builder.quad({-0.25f, -9, 0}, {9, 0, 0}, {0, 18, 0}, right);
        const RenderOptions options = albedo_options(1);
        const RenderResult both = render_scene(scene.take(), {}, albedo_camera(), options);
        for (const NamedMaterial* alone : {&core, &one}) {
            AlbedoScene wall;
            wall.wall(0, wall.add(alone->core, alone->layered ? &alone->layers : nullptr));
            const RenderResult expected = render_scene(wall.take(), {}, albedo_camera(), options);
            constexpr size_t border = 3;  // within the blocks of pixels that go together
            const size_t first = alone == &core ? 0 : border;
            const size_t end = alone == &core ? border : side;
            for (size_t y = 0; y < side; ++y) {
                for (size_t x = first; x < end; ++x) {
                    const size_t at = (y * side + x) * 3;
                    const auto pixel = [&](const RenderResult& result) {
                        const float* values = result.film.layers.front().pixels.data() + at;
                        return Vec3f{values[0], values[1], values[2]};
                    };
                    expect_color(pixel(both), pixel(expected), 1e-5f, one.name);
                }
            }
        }
    }
}

/// A mirror that fills the view, and behind the camera a wall that tells its base colour exactly.
Scene mirror_and_wall(const Vec3f& wall, float mirror_roughness = 0) {
    AlbedoScene scene;
    Material unlit = colored(wall, 1, 0);
    unlit.flags |= material_unlit;
    scene.wall(0, scene.add(colored(copper, mirror_roughness, 1)));
    scene.wall(6, scene.add(unlit), -1);
    return scene.take();
}

TEST(AlbedoLayer, ComesThroughAMirror) {
    const Vec3f wall{0.5f, 0.25f, 0.75f};
    const auto albedo = [&](float roughness, const RenderOptions& options) {
        return mean_albedo(render_scene(
            mirror_and_wall(wall, roughness), {constant_environment(1)}, albedo_camera(), options));
    };
    RenderOptions options = albedo_options(16);
    expect_color(albedo(0, options), copper * wall, 2e-3f, "mirror");
    options.integrator = Integrator::direct;  // the mirror is its last bounce, but one more hit
    expect_color(albedo(0, options), copper * wall, 2e-3f, "direct light");
    options.integrator = Integrator::path;
    expect_color(albedo(0.3f, options), copper, 0.02f, "rough metal tells its own");
    for (const Integrator pathless : {Integrator::raycast, Integrator::ao}) {
        options.integrator = pathless;
        expect_color(albedo(0, options), copper, 2e-3f, "there is no path to follow");
    }
}

TEST(AlbedoLayer, ComesThroughBothMirrorsOfARow) {
    AlbedoScene scene;
    Material unlit = colored({0.5f, 0.5f, 0.5f}, 1, 0);
    unlit.flags |= material_unlit;
    const int32_t mirror = scene.add(colored(copper, 0, 1));
    // Two mirrors at 45 degrees send light from +Z over -X back to +Z, beside the camera.
    scene.builder.quad({-2, -9, -2}, {4, 0, 4}, {0, 18, 0}, mirror);
    scene.builder.quad({-8, -9, 2}, {4, 0, -4}, {0, 18, 0}, mirror);
    scene.wall(9, scene.add(unlit), -1);
    const RenderResult result =
        render_scene(scene.take(), {constant_environment(1)}, albedo_camera(), albedo_options(16));
    // Schlick's reflectance at 45 degrees, where the cosine is 1 / sqrt(2).
    const float rise = std::pow(1 - 1 / std::numbers::sqrt2_v<float>, 5.0f);
    const Vec3f once = copper + (Vec3f{1, 1, 1} - copper) * rise;
    expect_color(mean_albedo(result), once * once * 0.5f, 4e-3f, "two mirrors");
}

TEST(AlbedoLayer, BlendsWhatGlassReflectsAndWhatIsBehind) {
    const Vec3f wall{0.5f, 0.25f, 0.75f};
    AlbedoScene scene;
    Material unlit = colored(wall, 1, 0);
    unlit.flags |= material_unlit;
    const MaterialLayers pane = glass_layers();
    scene.wall(0, scene.add(unlit));
    scene.wall(1, scene.add(glass_material(), &pane));
    const RenderResult result =
        render_scene(scene.take(), {constant_environment(1)}, albedo_camera(), albedo_options(256));
    // A reflected path leaves the scene: white.
    const auto passes = static_cast<float>(pane_lets_pass(1));
    const Vec3f white{1, 1, 1};
    expect_color(
        mean_albedo(result), wall * passes + white * (1 - passes), 4e-3f, "pane before a wall");
}

TEST(AlbedoLayer, OfGlassBeforeNothingIsWhiteAndOfNothingBlack) {
    AlbedoScene scene;
    const MaterialLayers pane = glass_layers();
    const int32_t glass = scene.add(glass_material(), &pane);
    scene.builder.quad({0, -9, 0}, {9, 0, 0}, {0, 18, 0}, glass);  // the right half
    const RenderResult result =
        render_scene(scene.take(), {constant_environment(1)}, albedo_camera(), albedo_options(64));
    const UnsetArray<float>& pixels = result.film.layers.front().pixels;
    for (size_t x = 0; x < side; ++x) {
        EXPECT_NEAR(pixels[(3 * side + x) * 3], x < side / 2 ? 0 : 1, 0.02) << x;
    }
}

TEST(AlbedoLayer, LeavesTheBeautyAndDependsOnNeitherTilesNorCrops) {
    const Vec3f wall{0.5f, 0.25f, 0.75f};
    const auto rendered = [&](const RenderOptions& options) {
        AlbedoScene scene;
        const MaterialLayers pane = glass_layers(0.995f);
        scene.wall(0, scene.add(colored(copper, 0, 1)));
        scene.wall(1, scene.add(glass_material(), &pane));
        scene.wall(6, scene.add(colored(wall, 0.7f, 0)), -1);
        return render_scene(scene.take(), {constant_environment(1)}, albedo_camera(), options).film;
    };
    RenderOptions options = albedo_options(20);
    const Film whole = rendered(options);
    options.tile_size = 3;
    options.crop = PixelRect{2, 1, 5, 6};
    const Film part = rendered(options);
    for (size_t y = 0; y < 6; ++y) {
        const float* from = whole.layers[0].pixels.data() + ((y + 1) * side + 2) * 3;
        EXPECT_EQ(std::memcmp(part.layers[0].pixels.data() + y * 15, from, 60), 0) << y;
    }
    RenderOptions alone = albedo_options(20);
    alone.layers.clear();
    const Film beauty = rendered(alone);
    EXPECT_EQ(std::memcmp(beauty.pixels.data(), whole.pixels.data(), whole.pixels.size() * 4), 0);
}

}  // namespace
}  // namespace obscura::test
