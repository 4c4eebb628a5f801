// app/info_json.cpp - what `obscura info --json` says about a scene.
// SPDX-License-Identifier: Apache-2.0
#include "app/camera_build.h"
#include "app/framing.h"
#include "app/info_report.h"
#include "base/json_writer.h"
#include "camera/matrices.h"

#include <cmath>
#include <numeric>

namespace obscura {

namespace {

void write_names(JsonWriter& json, const char* key, const std::vector<std::string>& names) {
    json.key(key).begin_array();
    for (const std::string& name : names)
        json.value(name);
    json.end_array();
}

void write_counts(JsonWriter& json,
                  const char* key,
                  const char* count_key,
                  const std::vector<NamedCount>& items) {
    json.key(key).begin_array();
    for (const NamedCount& item : items) {
        json.begin_object().member("name", item.name).member(count_key, item.count).end_object();
    }
    json.end_array();
}

void write_animations(JsonWriter& json, const AssetInfo& info) {
    json.key("animations").begin_array();
    for (const AnimationInfo& animation : info.animations) {
        json.begin_object().member("name", animation.name).member("channels", animation.channels);
        json.member("duration_s", animation.end_s).end_object();
    }
    json.end_array();
}

/// A 4x4 matrix for column vectors, row by row.
void write_matrix(JsonWriter& json, const char* key, const Affined& matrix) {
    json.key(key).begin_array();
    for (const auto& row : matrix.m) {
        for (const double number : row)
            json.value(number);
    }
    for (const double number : {0.0, 0.0, 0.0, 1.0})
        json.value(number);
    json.end_array();
}

/// World to normalised device coordinates in the picture that the file's camera names, where there
/// is such a matrix; for column vectors, row by row.
void write_ndc(JsonWriter& json, const SceneCamera& source, const Affined& rigid) {
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
    if (!matrices.has_ndc) return;
    json.key("ndc_from_world").begin_array();
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c)
            json.value(static_cast<double>(matrices.world_to_ndc[4 * c + r]));
    }
    json.end_array();
}

void write_triple(JsonWriter& json, const char* key, const float* values) {
    json.key(key).begin_array();
    for (int i = 0; i < 3; ++i)
        json.value(static_cast<double>(values[i]));
    json.end_array();
}

void write_images(JsonWriter& json, const AssetInfo& info) {
    size_t all_bytes = 0;
    json.key("textures").begin_array();
    for (const ImageInfo& image : info.images) {
        json.begin_object();
        json.member("name", image.name);
        json.member("format", image.format);
        json.member("width", image.width);
        json.member("height", image.height);
        json.member("bits", image.bits);
        json.member("used_as_color", image.used_as_color);
        json.member("used_as_data", image.used_as_data);
        json.member("memory_bytes", texture_bytes(image));
        json.end_object();
        all_bytes += texture_bytes(image);
    }
    json.end_array();
    json.member("texture_memory_bytes", all_bytes);
}

void write_lights(JsonWriter& json, const Scene& scene) {
    json.key("lights").begin_array();
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const PunctualLight& light = scene.lights[i];
        json.begin_object();
        json.member("name", i < scene.info.light_names.size() ? scene.info.light_names[i] : "");
        json.member("type", light_type_name(light));
        write_triple(json, "intensity", light.intensity);
        json.member("unit", light_unit_name(light));
        write_triple(json, "position", light.position);
        write_triple(json, "direction", light.direction);
        json.key("range_m");
        light.range > 0 ? json.value(static_cast<double>(light.range)) : json.value(INFINITY);
        json.end_object();
    }
    json.end_array();
}

void write_cameras(JsonWriter& json, const Scene& scene) {
    json.key("cameras").begin_array();
    for (const SceneCamera& camera : scene.cameras) {
        json.begin_object();
        json.member("name", camera.name);
        json.member("type", camera_type_name(camera));
        json.member("model", camera_model_name(camera));
        json.key("settings").begin_object();
        for (const auto& [name, value] : settings_texts(camera.settings))
            json.member(name, value);
        json.end_object();
        if (camera.type == SceneCameraType::orthographic) {
            json.member("xmag_m", camera.xmag_m);
            json.member("ymag_m", camera.ymag_m);
        } else {
            json.member("yfov_rad", camera.yfov_rad);
            json.key("aspect");
            json.value(camera.aspect > 0 ? camera.aspect : static_cast<double>(NAN));
        }
        json.member("znear_m", camera.znear_m);
        json.key("zfar_m");
        json.value(camera.zfar_m > 0 ? camera.zfar_m : static_cast<double>(INFINITY));
        write_matrix(json, "world_from_node", camera.world_from_camera);
        const Result<Affined> rigid = rigid_part(camera.world_from_camera, camera.name);
        if (rigid) {
            write_matrix(json, "world_from_camera", *rigid);
            write_matrix(json, "camera_from_world", inverse(*rigid));
            write_ndc(json, camera, *rigid);
        }
        json.end_object();
    }
    json.end_array();
}

void write_extensions(JsonWriter& json, const AssetInfo& info) {
    json.key("extensions").begin_array();
    for (const ExtensionInfo& extension : info.extensions) {
        json.begin_object();
        json.member("name", extension.name);
        json.member("required", extension.required);
        json.member("supported", extension.supported);
        write_names(json, "materials", extension.materials);
        json.end_object();
    }
    json.end_array();
}

}  // namespace

std::string info_json(const Scene& scene, const std::vector<std::string>& warnings) {
    const AssetInfo& info = scene.info;
    JsonWriter json;
    json.begin_object();
    json.member("version", OBSCURA_VERSION);
    json.member("file", info.file_name);
    json.member("gltf_version", info.version);
    json.member("generator", info.generator);
    json.member("copyright", info.copyright);
    write_names(json, "scenes", info.scenes);
    json.member("scene", info.scene);
    write_names(json, "variants", info.variants);
    json.member("variant", info.variant);
    json.key("bounds");
    if (scene.bounds.empty()) {
        json.value(NAN);
    } else {
        const float low[3] = {scene.bounds.low.x, scene.bounds.low.y, scene.bounds.low.z};
        const float high[3] = {scene.bounds.high.x, scene.bounds.high.y, scene.bounds.high.z};
        json.begin_object();
        write_triple(json, "low_m", low);
        write_triple(json, "high_m", high);
        json.end_object();
    }
    write_counts(json, "meshes", "triangles", info.meshes);
    json.member("triangles_in_file", triangles_in_file(info));
    json.member("triangles_in_world", info.triangles_in_world);
    write_counts(json, "shapes", "placed", info.shapes);
    json.member("instances", scene.instances.size());
    json.member("points", info.points_in_world);
    json.member("line_segments", info.line_segments_in_world);
    json.member("splats", info.splats_in_world);
    write_names(json, "materials", file_materials(scene));
    write_images(json, info);
    write_lights(json, scene);
    json.member("environment", info.environment);
    write_cameras(json, scene);
    write_animations(json, info);
    write_extensions(json, info);
    json.member("parse_s", info.parse_seconds);
    write_names(json, "warnings", warnings);
    json.end_object();
    return std::move(json).take();
}

}  // namespace obscura
