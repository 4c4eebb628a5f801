// gltf/materials/lights_cameras.cpp - places lights and cameras in world space.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/lights_cameras.h"

#include "gltf/chosen_parts.h"
#include "image/rendering_space.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace obscura::gltf {

namespace {

std::optional<Vec3d> unit(const Vec3d& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    return v * (1.0 / length);
}

/// The rotation and translation of a transform: -Z stays, +Y is made orthogonal to it.
std::optional<Affined> rigid_part(const Affined& transform) {
    const std::optional<Vec3d> back = unit(transform_vector(transform, Vec3d{0, 0, 1}));
    const std::optional<Vec3d> rough_up = unit(transform_vector(transform, Vec3d{0, 1, 0}));
    if (!back || !rough_up) return std::nullopt;
    const Vec3d across = *rough_up - *back * dot(*rough_up, *back);
    if (!(length(across) > 1e-9)) return std::nullopt;
    const Vec3d up = *unit(across);
    const Vec3d right = cross(up, *back);
    Affined out;
    const Vec3d columns[3] = {right, up, *back};
    for (int c = 0; c < 3; ++c) {
        out.m[0][c] = columns[c].x;
        out.m[1][c] = columns[c].y;
        out.m[2][c] = columns[c].z;
    }
    for (int r = 0; r < 3; ++r) {
        out.m[r][3] = transform.m[r][3];
        if (!std::isfinite(out.m[r][3])) return std::nullopt;
    }
    return out;
}

Result<SceneCamera> place_camera(const Document& document, const PlacedNode& place) {
    const GltfNode& node = document.nodes[static_cast<size_t>(place.node)];
    const GltfCamera& camera = document.cameras[static_cast<size_t>(node.camera)];
    const std::optional<Affined> rigid = rigid_part(place.world_from_node);
    if (!rigid) {
        return fail(ExitCode::bad_data,
                    "E-CAM-MATRIX",
                    document.at("nodes", static_cast<size_t>(place.node)),
                    "the camera's world matrix is singular or not finite");
    }
    SceneCamera out;
    out.name = !camera.name.empty() ? camera.name
               : !node.name.empty() ? node.name
                                    : "camera " + std::to_string(node.camera);
    out.type = camera.orthographic ? SceneCameraType::orthographic : SceneCameraType::perspective;
    out.world_from_camera = *rigid;
    out.yfov_rad = camera.yfov_rad;
    out.aspect = camera.aspect;
    out.xmag_m = camera.xmag_m;
    out.ymag_m = camera.ymag_m;
    out.znear_m = camera.znear_m;
    out.zfar_m = camera.zfar_m;
    out.settings = camera.settings;
    return out;
}

/// 1 - cosine, to the last digits of small angles, too.
double versine(double angle_rad) {
    const double half = std::sin(angle_rad / 2);
    return 2 * half * half;
}

/// KHR_lights_punctual, "Inner and Outer Cone Angles": attenuation is linear in the cosine. An
/// inner angle that is not the smaller one gives an edge of a thousandth of the cone.
void set_cone(const GltfLight& light, PunctualLight& out) {
    const double outer = versine(light.outer_cone_rad);
    const double inner = versine(std::min(light.inner_cone_rad, light.outer_cone_rad));
    const double width = std::max({outer - inner, 0.001 * outer, 1e-30});
    out.spot_scale = static_cast<float>(1 / width);
    out.spot_on_axis = static_cast<float>(outer / width);
}

/// Nothing when the node's transform leaves the light no position or direction.
std::optional<PunctualLight> place_light(const GltfLight& light,
                                         const Affined& world,
                                         double factor) {
    const std::optional<Vec3d> direction = unit(transform_vector(world, Vec3d{0, 0, -1}));
    const bool directed = light.type != GltfLightType::point;
    if (directed && !direction) return std::nullopt;
    PunctualLight out;
    for (int axis = 0; axis < 3; ++axis) {
        out.position[axis] = static_cast<float>(world.m[axis][3]);
        if (!std::isfinite(out.position[axis])) return std::nullopt;
        const double power =
            std::min(light.color[static_cast<size_t>(axis)] * light.intensity * factor, brightest);
        out.intensity[axis] = static_cast<float>(power);
    }
    const Vec3d aim = direction.value_or(Vec3d{0, 0, -1});
    out.direction[0] = static_cast<float>(aim.x);
    out.direction[1] = static_cast<float>(aim.y);
    out.direction[2] = static_cast<float>(aim.z);
    out.range = static_cast<float>(light.range);
    switch (light.type) {
        case GltfLightType::point:
            out.type = static_cast<int32_t>(PunctualType::point);
            break;
        case GltfLightType::spot:
            out.type = static_cast<int32_t>(PunctualType::spot);
            set_cone(light, out);
            break;
        case GltfLightType::directional:
            out.type = static_cast<int32_t>(PunctualType::directional);
            out.range = 0;  // the extension gives directional lights none
            break;
    }
    return out;
}

/// EXT_lights_ies, "Coordinate System Mapping": the lamp is aimed at -Z, and the plane of
/// horizontal angle 0 is that of X and Z. Angles count counter-clockwise seen from behind the lamp
/// in type C, clockwise in A and B, whose polar axis is X.
std::optional<PunctualLight> place_profile(const GltfProfileUse& use,
                                           const LightProfile& profile,
                                           const Affined& world,
                                           double factor) {
    const std::optional<Affined> rigid = rigid_part(world);
    if (!rigid) return std::nullopt;
    const Vec3d aim = transform_vector(*rigid, Vec3d{0, 0, -1});
    const Vec3d side = transform_vector(*rigid, Vec3d{1, 0, 0});
    const Vec3d& polar = profile.polar_is_aim ? aim : side;
    const Vec3d& zero = profile.polar_is_aim ? side : aim;
    PunctualLight out;
    out.type = static_cast<int32_t>(PunctualType::point);
    out.profile = use.profile;
    const auto store = [](const Vec3d& v, float* to) {
        to[0] = static_cast<float>(v.x);
        to[1] = static_cast<float>(v.y);
        to[2] = static_cast<float>(v.z);
    };
    store({rigid->m[0][3], rigid->m[1][3], rigid->m[2][3]}, out.position);
    store(polar, out.direction);
    store(zero, out.zero_axis);
    const Vec3d multiplier = Vec3d{use.color[0], use.color[1], use.color[2]} * use.multiplier;
    const Vec3d scaled = multiplier * factor;
    store({std::min(scaled.x, brightest),
           std::min(scaled.y, brightest),
           std::min(scaled.z, brightest)},
          out.intensity);
    return out;
}

/// Adds lights of nodes to the scene.
class LightPlacer {
public:
    LightPlacer(const Document& document, const LightChoice& choice, Scene& scene, Log& log)
        : document_(document), choice_(choice), scene_(scene), log_(log) {}

    void add(const PlacedNode& place);

private:
    void store(const std::optional<PunctualLight>& light, int node, const std::string& name);

    const Document& document_;
    const LightChoice& choice_;
    Scene& scene_;
    Log& log_;
};

void LightPlacer::store(const std::optional<PunctualLight>& light,
                        int node,
                        const std::string& name) {
    if (!light) {
        log_.warn(document_.at("nodes", static_cast<size_t>(node)),
                  "the node's matrix gives the light no place or direction; it is left out");
        return;
    }
    scene_.lights.push_back(*light);
    if (document_.from_rec709)
        convert_colors(*document_.from_rec709, scene_.lights.back().intensity);
    scene_.info.light_names.push_back(name);
    scene_.info.light_nodes.push_back(node);
}

void LightPlacer::add(const PlacedNode& place) {
    const GltfNode& node = document_.nodes[static_cast<size_t>(place.node)];
    if (node.light < 0 && node.ies.profile < 0) return;
    const std::string label = node_label(document_, place.node);
    if (node.light >= 0) {
        const GltfLight& light = document_.lights[static_cast<size_t>(node.light)];
        const double factor = light_factor(choice_, light.name, label);
        if (factor > 0)
            store(place_light(light, place.world_from_node, factor), place.node, light.name);
    }
    if (node.ies.profile >= 0) {
        const auto profile = static_cast<size_t>(node.ies.profile);
        const std::string& name = document_.profiles[profile].name;
        const double factor = light_factor(choice_, name, label);
        const LightProfile& measured = scene_.light_profiles[profile];
        if (factor > 0) {
            store(
                place_profile(node.ies, measured, place.world_from_node, factor), place.node, name);
        }
    }
}

}  // namespace

Result<void> add_lights_and_cameras(const Document& document,
                                    const std::vector<PlacedNode>& placed,
                                    const LightChoice& lights,
                                    Scene& scene,
                                    Log& log) {
    LightPlacer placer(document, lights, scene, log);
    for (const PlacedNode& place : placed) {
        const GltfNode& node = document.nodes[static_cast<size_t>(place.node)];
        if (node.camera >= 0) {
            Result<SceneCamera> camera = place_camera(document, place);
            if (!camera) return fail(std::move(camera.error()));
            scene.cameras.push_back(std::move(*camera));
        }
        if (place.visible) placer.add(place);
    }
    return {};
}

}  // namespace obscura::gltf
