// render/enclosed_lights.cpp - finds lights that their own fixture's closed mesh blocks.
// SPDX-License-Identifier: Apache-2.0
#include "render/enclosed_lights.h"

#include "accel/accel.h"
#include "render/prepared_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace obscura {

namespace {

constexpr int directions = 64;
constexpr size_t max_lights = 256;

/// Rays from one point, in columns with the padding that Accel asks for.
struct Rays {
    static constexpr size_t padded_count = directions + 16;
    using Column = std::array<float, padded_count>;
    Column ox = {}, oy = {}, oz = {}, dx = {}, dy = {}, dz = {}, tfar = {};
    Column t = {}, u = {}, v = {};
    std::array<int32_t, padded_count> instance = {}, primitive = {}, triangle = {};
    int count = 0;

    void add(const Vec3f& origin, const Vec3f& direction, float length) {
        const auto i = static_cast<size_t>(count++);
        ox[i] = origin.x;
        oy[i] = origin.y;
        oz[i] = origin.z;
        dx[i] = direction.x;
        dy[i] = direction.y;
        dz[i] = direction.z;
        tfar[i] = length;
    }
    void intersect(const Accel& accel, const SeeThrough& see_through) {
        const RayColumns rays{.ox = ox.data(),
                              .oy = oy.data(),
                              .oz = oz.data(),
                              .dx = dx.data(),
                              .dy = dy.data(),
                              .dz = dz.data(),
                              .tfar = tfar.data(),
                              .key = nullptr,
                              .count = count};
        const HitColumns hits{.t = t.data(),
                              .u = u.data(),
                              .v = v.data(),
                              .instance = instance.data(),
                              .primitive = primitive.data(),
                              .triangle = triangle.data()};
        accel.intersect(rays, hits, Coherence::incoherent, see_through);
    }
};

/// Height of the sphere; and of the cap of a spot's cone on the unit sphere.
constexpr float all_around = 2;
float height_of_cone(const PunctualLight& light) {
    const bool cone = light.type == static_cast<int32_t>(PunctualType::spot);
    return cone && light.spot_scale > 0
               ? std::min(light.spot_on_axis / light.spot_scale, all_around)
               : all_around;
}

/// Adds rays spread evenly over a cap of the unit sphere around a light's axis.
///
/// Source  the golden spiral: equal steps of height, each turned by the golden angle
void add_directions(const PunctualLight& light, float height, Rays& rays) {
    const Vec3f place{light.position[0], light.position[1], light.position[2]};
    const Vec3f axis{light.direction[0], light.direction[1], light.direction[2]};
    const Frame<float> frame = frame_around(axis);
    for (int i = 0; i < directions; ++i) {
        const float fraction = (static_cast<float>(i) + 0.5f) / static_cast<float>(directions);
        const float z = 1 - fraction * height;
        const float r = std::sqrt(std::max(0.0f, 1 - z * z));
        const float phi = static_cast<float>(i) * 2.3999632f;
        rays.add(place,
                 normalize(to_world(frame, Vec3f{r * std::cos(phi), r * std::sin(phi), z})),
                 unlimited);
    }
}

bool is_opaque(const Scene& scene, const Primitive& primitive) {
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    if ((material.flags & material_alpha_blend) != 0) return false;
    if (material.layers < 0) return true;
    const MaterialLayers& layers = scene.layers[static_cast<size_t>(material.layers)];
    return layers.transmission <= 0 && layers.diffuse_transmission <= 0;
}

/// The node at whose opaque faces all rays end; nothing if there is no single one.
std::optional<int32_t> enclosing_node(const Scene& scene, const Rays& rays) {
    std::optional<int32_t> node;
    for (size_t i = 0; i < static_cast<size_t>(rays.count); ++i) {
        if (rays.primitive[i] < 0) return {};
        const Primitive& primitive = scene.primitives[static_cast<size_t>(rays.primitive[i])];
        if (!is_opaque(scene, primitive)) return {};
        const int32_t met = rays.instance[i] < 0
                                ? primitive.node
                                : scene.instances[static_cast<size_t>(rays.instance[i])].node;
        if (met < 0 || (node && *node != met)) return {};
        node = met;
    }
    return node;
}

/// True when the eye is within the box of the hits, or sees the light with back faces culled.
bool sees_inside(const Accel& accel, const Rays& rays, const Vec3f& eye) {
    Vec3f low{INFINITY, INFINITY, INFINITY};
    Vec3f high = -low;
    const Vec3f light{rays.ox[0], rays.oy[0], rays.oz[0]};
    for (size_t i = 0; i < static_cast<size_t>(rays.count); ++i) {
        const Vec3f met = light + Vec3f{rays.dx[i], rays.dy[i], rays.dz[i]} * rays.t[i];
        low = -max3(-low, -met);
        high = max3(high, met);
    }
    const bool within = eye.x >= low.x && eye.x <= high.x && eye.y >= low.y && eye.y <= high.y &&
                        eye.z >= low.z && eye.z <= high.z;
    if (within) return true;
    const Vec3f to_light = light - eye;
    Rays look;
    look.add(eye, normalize(to_light), length(to_light));
    look.intersect(accel, {.culls_back_faces = true, .fixed_alpha = true});
    return look.primitive[0] < 0;
}

}  // namespace

std::vector<EnclosedLight> find_enclosed_lights(const PreparedScene& prepared, const Vec3f& eye) {
    const Scene& scene = prepared.scene();
    std::vector<EnclosedLight> out;
    for (size_t i = 0; i < std::min(scene.lights.size(), max_lights); ++i) {
        const PunctualLight& light = scene.lights[i];
        if (light.type == static_cast<int32_t>(PunctualType::directional)) continue;
        // A spot may light nothing but a floor, which does not enclose it.
        Rays cone, rays;
        add_directions(light, height_of_cone(light), cone);
        add_directions(light, all_around, rays);
        for (Rays* const some : {&cone, &rays})
            some->intersect(prepared.accel(), {.fixed_alpha = true, .passes = shadow_rays_pass});
        const std::optional<int32_t> node = enclosing_node(scene, cone);
        if (!node || enclosing_node(scene, rays) != node) continue;
        if (sees_inside(prepared.accel(), rays, eye)) continue;
        out.push_back({i, *node});
    }
    return out;
}

void warn_of_enclosed_lights(const PreparedScene& prepared, const Vec3f& eye, Log& log) {
    const AssetInfo& info = prepared.scene().info;
    const auto named = [](const char* what, size_t number, const std::vector<std::string>& names) {
        const std::string name = number < names.size() ? names[number] : "";
        return std::string(what) + " " + std::to_string(number) + (name.empty() ? "" : " ") + name;
    };
    for (const EnclosedLight& enclosed : find_enclosed_lights(prepared, eye)) {
        const std::string node = named("node", static_cast<size_t>(enclosed.node), info.node_names);
        log.warn(named("light", enclosed.light, info.light_names),
                 "the opaque surface of " + node +
                     " encloses it on all sides: none of its light comes out");
    }
}

}  // namespace obscura
