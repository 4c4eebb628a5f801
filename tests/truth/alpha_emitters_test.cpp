// tests/truth/alpha_emitters_test.cpp - emitters with alpha light as much as what is left of them.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/arena_images.h"
#include "support/scene_builder.h"
#include "support/shape_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace alpha_emitters_truth {

constexpr int alpha_image_size = 16;

Material glowing(uint32_t flags) {
    Material m;
    std::fill_n(m.base_color, 3, 0.0f);
    m.metallic = 0;
    std::fill_n(m.emission, 3, 10.0f);
    m.flags = flags;
    return m;
}

void add_ground(SceneBuilder& builder) {
    Material white;
    white.metallic = 0;
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material(white));
}

Mean radiance_of_ground(Scene scene, int strategies, int samples = 64) {
    RenderOptions options;
    options.width = options.height = alpha_image_size;
    options.samples_per_pixel = samples;
    options.strategies = strategies;
    const Camera camera =
        look_at({0, 1, 1.5f}, {0, 0, 0}, 0.02f, alpha_image_size, alpha_image_size);
    return film_mean(render_scene(std::move(scene), {}, camera, options).film);
}

void expect_same(const Mean& a, const Mean& b, const std::string& what) {
    EXPECT_NEAR(a.value, b.value, 4.0 * std::sqrt(a.error * a.error + b.error * b.error)) << what;
}

/// Gives the last primitive, a quad, the texture coordinates of the unit square.
void add_unit_uv(Scene& scene) {
    Primitive& p = scene.primitives.back();
    const uint32_t first = scene.indices[3 * static_cast<size_t>(p.first_triangle)];
    p.uv_base[0] = static_cast<int32_t>(scene.attributes.size()) - 2 * static_cast<int32_t>(first);
    scene.attributes.insert(scene.attributes.end(), {0, 0, 1, 0, 1, 1, 0, 1});
}

const uint32_t sharp = pack_sampler(Wrap::clamp, Wrap::clamp, true, true, MipMode::nearest, false);

/// A texture that is clear where u is below 0.5; `opaque`: alpha elsewhere.
int32_t half_clear(Scene& scene, uint32_t opaque) {
    return add_image(scene.textures, 8, sharp, [&](int x, int) {
        return (x < 4 ? 0U : opaque << 24U) | 0xFFFFFFU;
    });
}

/// A square lamp 1 m over the ground, facing down, of which only x > 0 is there.
Scene half_lamp(Material m, uint32_t opaque, float side = 1) {
    SceneBuilder builder;
    add_ground(builder);
    m.base_color_texture.texture = half_clear(builder.scene(), opaque);
    const float half = 0.5f * side;
    builder.quad({-half, 1, -half}, {side, 0, 0}, {0, 0, side}, builder.material(m));
    add_unit_uv(builder.scene());
    return builder.take();
}

/// Its known answer: half as large a lamp without alpha.
Scene whole_half() {
    SceneBuilder builder;
    add_ground(builder);
    builder.quad({0, 1, -0.5f}, {0.5f, 0, 0}, {0, 0, 1}, builder.material(glowing(0)));
    return builder.take();
}

TEST(AlphaEmitters, MaskedTrianglesLightAsWhatIsLeftOfThem) {
    const Mean expected = radiance_of_ground(whole_half(), 3, 256);
    for (const uint32_t sides : {0U, static_cast<uint32_t>(material_double_sided)}) {
        const Material m = glowing(material_alpha_mask | sides);
        for (const int strategies : {1, 2, 3}) {
            const Mean mean =
                radiance_of_ground(half_lamp(m, 255), strategies, strategies == 2 ? 1024 : 64);
            expect_same(mean, expected, "strategies " + std::to_string(strategies));
        }
    }
}

TEST(AlphaEmitters, BlendedTrianglesLightByTheirAlpha) {
    const Mean whole = radiance_of_ground(whole_half(), 3, 256);
    for (const int strategies : {1, 2, 3}) {
        const Mean mean = radiance_of_ground(
            half_lamp(glowing(material_alpha_blend), 102), strategies, strategies == 2 ? 1024 : 64);
        expect_same(mean,
                    {0.4 * whole.value, 0.4 * whole.error},
                    "strategies " + std::to_string(strategies));
    }
}

TEST(AlphaEmitters, LightSamplingFindsThem) {
    const Material m = glowing(material_alpha_mask);
    const Mean both = radiance_of_ground(half_lamp(m, 255, 0.2f), 3);
    const Mean bsdf = radiance_of_ground(half_lamp(m, 255, 0.2f), 2);
    EXPECT_LT(both.error, 0.25 * bsdf.error);
}

/// The alpha of vertices: 0 at x = -0.5, 1 at x = 0.5, in an instance that may be a mirror image.
Scene faded_lamp(float scale_x) {
    SceneBuilder builder;
    add_ground(builder);
    builder.quad(
        {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, builder.material(glowing(material_alpha_blend)));
    Scene& building = builder.scene();
    Primitive& p = building.primitives.back();
    const uint32_t first = building.indices[3 * static_cast<size_t>(p.first_triangle)];
    p.color_base =
        static_cast<int32_t>(building.attributes.size()) - 4 * static_cast<int32_t>(first);
    for (const float alpha : {0.0f, 1.0f, 1.0f, 0.0f})
        building.attributes.insert(building.attributes.end(), {1, 1, 1, alpha});
    Scene scene = builder.take();
    scene.world_primitive_count = 1;
    scene.meshes = {{1, 1}};
    Instance instance;
    instance.world_from_object.m[0][0] = instance.object_from_world.m[0][0] = scale_x;
    instance.mirrored = scale_x < 0 ? 1 : 0;
    scene.instances = {instance};
    return scene;
}

TEST(AlphaEmitters, AlphaOfVerticesAndMirrorImages) {
    // By symmetry, the lamp and its mirror image light the ground's middle alike, and together as
    // one without alpha does.
    SceneBuilder builder;
    add_ground(builder);
    builder.quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, builder.material(glowing(0)));
    const Mean whole = radiance_of_ground(builder.take(), 3, 256);
    for (const float scale_x : {1.0f, -1.0f}) {
        for (const int strategies : {1, 2, 3}) {
            const Mean mean =
                radiance_of_ground(faded_lamp(scale_x), strategies, strategies == 2 ? 1024 : 64);
            expect_same(mean,
                        {0.5 * whole.value, 0.5 * whole.error},
                        std::to_string(scale_x) + ", strategies " + std::to_string(strategies));
        }
    }
}

/// A shape with the half-clear texture, 1 m above the ground.
Scene shape_lamp(const ShapeRecord& record, uint32_t flags) {
    SceneBuilder builder;
    add_ground(builder);
    Material m = glowing(flags);
    m.base_color_texture.texture = half_clear(builder.scene(), 255);
    const int32_t index = builder.material(m);
    Scene scene = builder.take();
    Affined down;  // turned about x, so that +Y looks down
    down.m[1][1] = down.m[2][2] = -1;
    down.m[1][3] = 1;
    add_shape(scene, record, index, down);
    return scene;
}

TEST(AlphaEmitters, ShapesAgreeForAllStrategies) {
    const uint32_t both_sides = material_alpha_mask | material_double_sided;
    const struct {
        const char* name;
        ShapeRecord record;
        uint32_t flags;
        bool sampled;
    } cases[] = {
        {"rectangle", make_shape(ShapeKind::plane, 0.5f, 0.5f), material_alpha_mask, true},
        {"disk", make_shape(ShapeKind::disk, 0.5f), both_sides, true},
        {"sphere", make_shape(ShapeKind::sphere, 0.4f), material_alpha_mask, true},
        {"sphere whose inside shows", make_shape(ShapeKind::sphere, 0.4f), both_sides, false}};
    for (const auto& one : cases) {
        const Mean bsdf = radiance_of_ground(shape_lamp(one.record, one.flags), 2, 2048);
        EXPECT_GT(bsdf.value, 0.1) << one.name;
        for (const int strategies : {1, 3}) {
            if (strategies == 1 && !one.sampled) continue;
            expect_same(radiance_of_ground(shape_lamp(one.record, one.flags), strategies, 256),
                        bsdf,
                        std::string(one.name) + ", strategies " + std::to_string(strategies));
        }
    }
}

}  // namespace alpha_emitters_truth
}  // namespace obscura::test
