// tests/scene/thin_walls_test.cpp - which materials may let light pass straight through.
// SPDX-License-Identifier: Apache-2.0
#include "scene/thin_walls.h"

#include <gtest/gtest.h>

#include <functional>

namespace obscura {
namespace {

/// Clear glass, changed.
bool may_pass(const std::function<void(Scene&)>& change) {
    Scene scene;
    Material glass;
    glass.metallic = 0;
    glass.roughness = 0;
    glass.layers = 0;
    MaterialLayers layers;
    layers.transmission = 1;
    scene.materials = {glass};
    scene.layers = {layers};
    change(scene);
    return find_thin_walls(scene).at(0) != 0;
}

/// One texture of the texels' greens.
void set_roughness_texture(Scene& scene, const std::vector<uint32_t>& greens) {
    TextureRecord record;
    record.width = static_cast<int32_t>(greens.size());
    scene.textures.records = {record};
    for (const uint32_t green : greens)
        scene.textures.texels.push_back(0xFFFF00FFU | green << 8);
    scene.materials[0].metallic_roughness_texture.texture = 0;
}

TEST(ThinWallMaterials, AreSmoothThinAndLetLightThrough) {
    EXPECT_TRUE(may_pass([](Scene&) {}));
    EXPECT_TRUE(may_pass([](Scene& s) { s.materials[0].roughness = 0.0316F; }));
    EXPECT_FALSE(may_pass([](Scene& s) { s.materials[0].roughness = 0.032F; }));
    EXPECT_FALSE(may_pass([](Scene& s) { s.materials[0].metallic = 1; }));
    EXPECT_FALSE(may_pass([](Scene& s) { s.materials[0].flags = material_unlit; }));
    EXPECT_FALSE(may_pass([](Scene& s) { s.materials[0].layers = -1; }));
    EXPECT_FALSE(may_pass([](Scene& s) { s.layers[0].medium = 1; }));
    EXPECT_TRUE(may_pass([](Scene& s) {  // a cloud, whose boundary blurs nothing
        s.layers[0].medium = 1;
        s.layers[0].ior = 1.0005F;
        s.materials[0].roughness = 1;
    }));
    EXPECT_FALSE(may_pass([](Scene& s) { s.layers[0].transmission = 0; }));
}

TEST(ThinWallMaterials, OneSmoothTexelIsEnough) {
    const auto textured = [](float factor, const std::vector<uint32_t>& greens) {
        return may_pass([&](Scene& s) {
            s.materials[0].roughness = factor;
            s.materials[0].metallic = 1;  // the texture may say otherwise
            set_roughness_texture(s, greens);
        });
    };
    EXPECT_TRUE(textured(1, {200, 8, 255}));
    EXPECT_FALSE(textured(1, {200, 9, 255}));
    EXPECT_TRUE(textured(0.5F, {200, 16, 255}));
    EXPECT_FALSE(textured(0.5F, {200, 17, 255}));
}

}  // namespace
}  // namespace obscura
