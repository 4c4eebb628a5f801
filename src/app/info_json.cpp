// app/info_json.cpp - `obscura info --json`: a scene as JSON.
// SPDX-License-Identifier: Apache-2.0
#include "app/info_report.h"
#include "base/json/json.h"
#include "camera/matrices.h"
#include "film/cryptomatte_names.h"
#include "scene/node_primitives.h"
#include "session/camera_build.h"
#include "session/framing.h"

#include <cmath>
#include <numeric>

namespace obscura::app {

namespace {

Json counts_json(const char* count_key, const std::vector<NamedCount>& items) {
    Json out = Json::array();
    for (const NamedCount& item : items)
        out.push_back({{"name", item.name}, {count_key, item.count}});
    return out;
}

/// What the numbers of the layers id_node and instance stand for.
Json nodes_json(const Scene& scene) {
    const std::vector<std::string> paths = node_paths(scene.info);
    std::vector<std::vector<int32_t>> instances(paths.size());
    for_each_node_primitive(scene, [&](int32_t node, int32_t instance, const Primitive&) {
        if (node < 0 || instance < 0) return;
        std::vector<int32_t>& numbers = instances[static_cast<size_t>(node)];
        const bool is_new = numbers.empty() || numbers.back() != instance + 1;
        if (is_new) numbers.push_back(instance + 1);
    });
    Json out = Json::array();
    for (size_t node = 0; node < paths.size(); ++node) {
        out.push_back({{"id_node", node + 1},
                       {"path", paths[node]},
                       {"mesh", mesh_name(scene.info, node)},
                       {"instances", instances[node]}});
    }
    return out;
}

Json animations_json(const AssetInfo& info) {
    Json out = Json::array();
    for (const AnimationInfo& animation : info.animations) {
        out.push_back({{"name", animation.name},
                       {"channels", animation.channels},
                       {"duration_s", animation.end_s}});
    }
    return out;
}

/// A 4x4 matrix for column vectors, row by row.
Json matrix_json(const Affined& matrix) {
    Json out = Json::array();
    for (const auto& row : matrix.m) {
        for (const double number : row)
            out.push_back(number);
    }
    for (const double number : {0.0, 0.0, 0.0, 1.0})
        out.push_back(number);
    return out;
}

/// World to normalised device coordinates in the image that the file's camera names, if there is
/// such a matrix; for column vectors, row by row.
void add_ndc(const SceneCamera& source, const Affined& rigid, Json& json) {
    const bool parallel = source.type == SceneCameraType::orthographic;
    const double aspect = parallel ? source.xmag_m / source.ymag_m : source.aspect;
    CameraBasis basis;
    basis.world_from_camera = rigid;
    basis.tan_half_yfov = std::tan(0.5 * source.yfov_rad);
    basis.half_height_m = source.ymag_m;
    const CameraModel core = parallel ? CameraModel::orthographic : CameraModel::pinhole;
    const CameraModel model = implied_model(source.settings).value_or(core);
    constexpr int height_px = 1 << 20;  // so that the width can follow the aspect ratio
    if (!(aspect > 1e-3 && aspect < 1e3)) return;
    const int width_px = static_cast<int>(std::lround(height_px * aspect));
    const Result<Camera> camera = make_camera(basis, model, source.settings, {width_px, height_px});
    if (!camera) return;
    const double znear = std::max(source.znear_m, 1e-6);
    const double zfar = source.zfar_m > znear ? source.zfar_m : 1e6 * znear;
    const CameraMatrices matrices = camera_matrices(*camera, znear, zfar);
    if (!matrices.world_to_ndc) return;
    Json& out = json["ndc_from_world"] = Json::array();
    for (size_t r = 0; r < 4; ++r) {
        for (size_t c = 0; c < 4; ++c)
            out.push_back(static_cast<double>((*matrices.world_to_ndc)[4 * c + r]));
    }
}

Json triple_json(const float* values) {
    const auto number = [&](int i) { return static_cast<double>(values[i]); };
    return Json::array({number(0), number(1), number(2)});
}

Json triple_json(const Vec3f& v) {
    const float values[3] = {v.x, v.y, v.z};
    return triple_json(values);
}

void add_images(const AssetInfo& info, Json& json) {
    size_t all_bytes = 0;
    Json& textures = json["textures"] = Json::array();
    for (const ImageInfo& image : info.images) {
        textures.push_back({{"name", image.name},
                            {"format", image.format},
                            {"width", image.width},
                            {"height", image.height},
                            {"bits", image.bits},
                            {"used_as_color", image.used_as_color},
                            {"used_as_data", image.used_as_data},
                            {"memory_bytes", texture_bytes(image)}});
        all_bytes += texture_bytes(image);
    }
    json["texture_memory_bytes"] = all_bytes;
}

Json lights_json(const Scene& scene) {
    Json out = Json::array();
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const PunctualLight& light = scene.lights[i];
        const double range_m = light.range > 0 ? static_cast<double>(light.range) : INFINITY;
        const auto& names = scene.info.light_names;
        out.push_back({{"name", i < names.size() ? names[i] : ""},
                       {"type", light_type_name(light)},
                       {"intensity", triple_json(light.intensity)},
                       {"unit", light_unit_name(light)},
                       {"position", triple_json(light.position)},
                       {"direction", triple_json(light.direction)},
                       {"range_m", range_m}});
    }
    return out;
}

Json camera_json(const SceneCamera& camera) {
    Json out;
    out["name"] = camera.name;
    out["type"] = camera_type_name(camera);
    out["model"] = camera_model_name(camera);
    Json& settings = out["settings"] = Json::object();
    for (const auto& [name, value] : settings_texts(camera.settings))
        settings[name] = value;
    if (camera.type == SceneCameraType::orthographic) {
        out["xmag_m"] = camera.xmag_m;
        out["ymag_m"] = camera.ymag_m;
    } else {
        out["yfov_rad"] = camera.yfov_rad;
        out["aspect"] = camera.aspect > 0 ? Json(camera.aspect) : Json();
    }
    out["znear_m"] = camera.znear_m;
    out["zfar_m"] = camera.zfar_m > 0 ? Json(camera.zfar_m) : Json();
    out["world_from_node"] = matrix_json(camera.world_from_camera);
    const Result<Affined> rigid = rigid_part(camera.world_from_camera, camera.name);
    if (rigid) {
        out["world_from_camera"] = matrix_json(*rigid);
        out["camera_from_world"] = matrix_json(inverse(*rigid));
        add_ndc(camera, *rigid, out);
    }
    return out;
}

Json cameras_json(const Scene& scene) {
    Json out = Json::array();
    for (const SceneCamera& camera : scene.cameras)
        out.push_back(camera_json(camera));
    return out;
}

Json extensions_json(const AssetInfo& info) {
    Json out = Json::array();
    for (const ExtensionInfo& extension : info.extensions) {
        out.push_back({{"name", extension.name},
                       {"required", extension.required},
                       {"supported", extension.supported},
                       {"materials", extension.materials}});
    }
    return out;
}

Json bounds_json(const Scene& scene) {
    if (scene.bounds.empty()) return {};
    return {{"low_m", triple_json(scene.bounds.low)}, {"high_m", triple_json(scene.bounds.high)}};
}

}  // namespace

std::string info_json(const Scene& scene, const std::vector<std::string>& warnings) {
    const AssetInfo& info = scene.info;
    Json json;
    json["version"] = OBSCURA_VERSION;
    json["file"] = info.file_name;
    json["gltf_version"] = info.version;
    json["generator"] = info.generator;
    json["copyright"] = info.copyright;
    json["scenes"] = info.scenes;
    json["scene"] = info.scene;
    json["variants"] = info.variants;
    json["variant"] = info.variant;
    json["bounds"] = bounds_json(scene);
    json["nodes"] = nodes_json(scene);
    json["meshes"] = counts_json("triangles", info.meshes);
    json["triangles_in_file"] = triangles_in_file(info);
    json["triangles_in_world"] = info.triangles_in_world;
    json["shapes"] = counts_json("placed", info.shapes);
    json["instances"] = scene.instances.size();
    json["points"] = info.points_in_world;
    json["line_segments"] = info.line_segments_in_world;
    json["splats"] = info.splats_in_world;
    json["materials"] = file_materials(scene);
    add_images(info, json);
    json["lights"] = lights_json(scene);
    json["environment"] = info.environment;
    json["cameras"] = cameras_json(scene);
    json["animations"] = animations_json(info);
    json["extensions"] = extensions_json(info);
    json["parse_s"] = info.parse_seconds;
    json["warnings"] = warnings;
    return json_document(json);
}

}  // namespace obscura::app
