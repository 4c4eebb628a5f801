// tests/support/thin_wall_scenes.h - floors under thin panes, and the light that passes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/scene_builder.h"
#include "truth/reference.h"
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace obscura::test {

inline constexpr int thin_wall_image_size = 16;

/// Smooth, clear and colourless, of index 1.5, seen from both sides.
inline Material glass_material() {
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.flags = material_double_sided;
    return m;
}

inline MaterialLayers glass_layers(float transmission = 1) {
    MaterialLayers layers;
    layers.transmission = transmission;
    return layers;
}

/// Fraction of light that one white pane of index 1.5 transmits at an angle of this cosine: one
/// face, by KHR_materials_transmission's Schlick term.
inline double pane_lets_pass(double cosine) {
    return 1 - (0.04 + 0.96 * std::pow(1 - cosine, 5));
}

/// A white floor around the origin, facing up; objects are added above it.
class ThinWallScene {
public:
    ThinWallScene() {
        Material white;
        white.metallic = 0;
        white.roughness = 1;
        builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material(white));
    }

    int32_t add(Material material, const MaterialLayers& layers) {
        material.layers = static_cast<int32_t>(layers_.size());
        layers_.push_back(layers);
        return builder.material(material);
    }
    /// A level square pane of 2 `half` metres.
    void pane(float height, int32_t index, float half = 100) {
        builder.quad({-half, height, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, index);
    }
    void light(const PunctualLight& light) { lights_.push_back(light); }

    Scene take() {
        Scene scene = builder.take();
        scene.layers = layers_;
        scene.lights = lights_;
        return scene;
    }

    SceneBuilder builder;

private:
    std::vector<MaterialLayers> layers_;
    std::vector<PunctualLight> lights_;
};

inline Affined raised(double height) {
    Affined out;
    out.m[1][3] = height;
    return out;
}

inline Affinef placing(const Vec3f& scale, const Vec3f& to) {
    Affinef out;
    const float s[3] = {scale.x, scale.y, scale.z};
    const float t[3] = {to.x, to.y, to.z};
    for (int r = 0; r < 3; ++r) {
        out.m[r][r] = s[r];
        out.m[r][3] = t[r];
    }
    return out;
}

/// Turns the last primitive of a scene without instances into one that is at these evenly spaced
/// positions while the shutter is open; with one position it stands still.
inline void place_last(Scene& scene, const std::vector<Affinef>& places) {
    const int32_t index = --scene.world_primitive_count;
    scene.meshes.push_back({index, 1});
    Instance instance;
    instance.world_from_object = places[0];
    instance.object_from_world = inverse(places[0]);
    instance.mirrored = determinant(places[0]) < 0 ? 1 : 0;
    if (places.size() > 1) {
        instance.motion = 0;
        scene.motion.steps = static_cast<int32_t>(places.size());
        scene.motion.instances = places;
    }
    scene.instances.push_back(instance);
}

inline PunctualLight lamp_at(const Vec3f& place) {
    PunctualLight light;
    light.position[0] = place.x;
    light.position[1] = place.y;
    light.position[2] = place.z;
    std::fill_n(light.intensity, 3, 10.0f);
    return light;
}

/// Light that comes from (0.6, 0.8, 0).
inline PunctualLight slanting_sun() {
    PunctualLight light;
    light.type = static_cast<int32_t>(PunctualType::directional);
    light.direction[0] = -0.6f;
    light.direction[1] = -0.8f;
    light.direction[2] = 0;
    std::fill_n(light.intensity, 3, 10.0f);
    return light;
}

struct ThinWallView {
    int samples = 4;
    int bounces = 0;  ///< 0: the floor's direct light alone
    int strategies = sample_lights | sample_bsdfs;
    uint64_t seed = 0;
    Integrator integrator = Integrator::path;
    LightingOptions lighting = {};
};

/// The floor at the origin, seen from straight above by an eye below all panes.
inline Film floor_film(Scene scene, const ThinWallView& view = {}) {
    RenderOptions options;
    options.width = options.height = thin_wall_image_size;
    options.samples_per_pixel = view.samples;
    options.max_bounces = view.bounces;
    options.strategies = view.strategies;
    options.seed = view.seed;
    options.integrator = view.integrator;
    const Camera camera =
        look_at({0, 0.5f, 0}, {0, 0, 0}, 1e-4f, thin_wall_image_size, thin_wall_image_size);
    return render_scene(std::move(scene), view.lighting, camera, options).film;
}

inline double floor_value(Scene scene, const ThinWallView& view = {}, size_t channel = 0) {
    return film_mean(floor_film(std::move(scene), view), channel).value;
}

}  // namespace obscura::test
