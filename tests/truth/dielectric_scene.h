// tests/truth/dielectric_scene.h - scenes of transparent solids under a white sky.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/media.h"

#include "support/scene_builder.h"
#include "truth/reference.h"
#include <array>
#include <utility>
#include <vector>

namespace obscura::test {

inline constexpr int image_size = 16;

/// Clear, smooth, and colourless except for absorption inside.
inline MaterialLayers dielectric(float ior, const Vec3f& absorption) {
    MaterialLayers layers;
    layers.ior = ior;
    layers.transmission = 1;
    layers.medium = 1;
    layers.attenuation[0] = absorption.x;
    layers.attenuation[1] = absorption.y;
    layers.attenuation[2] = absorption.z;
    return layers;
}

/// A scene whose materials have layers: record i of both.
class DielectricScene {
public:
    int32_t add(const MaterialLayers& layers) {
        Material m;
        m.metallic = 0;
        m.roughness = 0;
        m.flags = material_double_sided;
        m.layers = static_cast<int32_t>(layers_.size());
        layers_.push_back(layers);
        return builder.material(m);
    }
    /// An axis-aligned box, fronts outside.
    void box(const Vec3f& low, const Vec3f& high, int32_t index) {
        const Vec3f d = high - low;
        const Vec3f x{d.x, 0, 0};
        const Vec3f y{0, d.y, 0};
        const Vec3f z{0, 0, d.z};
        builder.quad(low, z, y, index);
        builder.quad(low + x, y, z, index);
        builder.quad(low, x, z, index);
        builder.quad(low + y, z, x, index);
        builder.quad(low, y, x, index);
        builder.quad(low + z, x, y, index);
    }
    Scene take() {
        Scene scene = builder.take();
        scene.layers = layers_;
        number_media(scene);
        return scene;
    }

    SceneBuilder builder;

private:
    std::vector<MaterialLayers> layers_;
};

struct DielectricView {
    int samples = 256;
    int bounces = 32;
    float sky = 1;
};

/// Straight down the z axis: means of red, green and blue.
inline std::array<Mean, 3> means_from_front(Scene scene, const DielectricView& view) {
    RenderOptions options;
    options.width = options.height = image_size;
    options.samples_per_pixel = view.samples;
    options.max_bounces = view.bounces;
    LightingOptions lighting;
    lighting.environment = constant_environment(view.sky);
    const Camera camera = look_at({0, 0, 1000}, {0, 0, 0}, 1e-5f, image_size, image_size);
    const auto film = render_scene(std::move(scene), lighting, camera, options).film;
    return {film_mean(film, 0), film_mean(film, 1), film_mean(film, 2)};
}

inline Vec3d seen_from_front(Scene scene, const DielectricView& view = {}) {
    const std::array<Mean, 3> means = means_from_front(std::move(scene), view);
    return {means[0].value, means[1].value, means[2].value};
}

}  // namespace obscura::test
