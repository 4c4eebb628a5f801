// gltf/parse/document_nodes.cpp - reads nodes, scenes, cameras and lights.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_nodes.h"

#include "gltf/geometry/instancing.h"
#include "gltf/parse/camera_extension.h"
#include "gltf/parse/document_lights.h"
#include "gltf/parse/document_shapes.h"
#include "gltf/parse/light_camera_entries.h"
#include "gltf/parse/model.h"
#include "gltf/parse/trs.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

constexpr const char* punctual_name = "KHR_lights_punctual";

Affined affine_from_columns(const std::vector<double>& columns) {
    Affined out;
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 4; ++c)
            out.m[r][c] = columns[c * 4 + r];
    }
    return out;
}

/// Numbers that the file gives; else `out` stays as it is.
template <size_t N>
void take_numbers(const std::vector<double>& numbers, std::array<double, N>& out) {
    if (numbers.size() == N) std::copy_n(numbers.begin(), N, out.begin());
}

void read_transform(DocumentReading& reading,
                    const tinygltf::Node& node,
                    const ModelElement& place,
                    GltfNode& out) {
    if (node.matrix.size() == 16) {
        const std::vector<double>& columns = node.matrix;
        if (columns[3] != 0 || columns[7] != 0 || columns[11] != 0 || columns[15] != 1) {
            reading.log.warn(reading.document.at(place.pointer()),
                             "the matrix's last row is not 0 0 0 1; it is ignored");
        }
        out.has_matrix = true;
        out.parent_from_node = affine_from_columns(columns);
        return;
    }
    take_numbers(node.translation, out.trs.translation);
    take_numbers(node.rotation, out.trs.rotation);
    take_numbers(node.scale, out.trs.scale);
    if (!normalize_quaternion(out.trs.rotation)) {
        place.fault("rotation", "E-NODE-ROTATION", "the quaternion has no length");
    }
    out.parent_from_node = affine_from_trs(out.trs);
}

void check_camera(const ModelElement& object, GltfCamera& out) {
    // tinygltf says 0 where these are absent; where the file says 0, the preflight refuses it.
    const auto fault = finish_camera(out, {out.aspect != 0, out.zfar_m != 0});
    if (fault) object.fault(fault->key, fault->id, fault->message);
}

GltfCamera read_perspective(const tinygltf::PerspectiveCamera& lens, const ModelElement& object) {
    GltfCamera out;
    out.yfov_rad = lens.yfov;
    out.aspect = lens.aspectRatio;
    out.znear_m = lens.znear;
    out.zfar_m = lens.zfar;
    check_camera(object, out);
    return out;
}

GltfCamera read_orthographic(DocumentReading& reading,
                             const tinygltf::OrthographicCamera& lens,
                             const ModelElement& object) {
    GltfCamera out;
    out.orthographic = true;
    out.xmag_m = lens.xmag;
    out.ymag_m = lens.ymag;
    out.znear_m = lens.znear;
    out.zfar_m = lens.zfar;
    if (out.xmag_m < 0 || out.ymag_m < 0) {
        reading.log.warn(reading.document.at(object.pointer()),
                         "a magnification is negative; its absolute value is used");
    }
    check_camera(object, out);
    return out;
}

GltfLightType read_light_type(const tinygltf::Light& light, const ModelElement& place) {
    if (light.type == "spot") return GltfLightType::spot;
    if (light.type == "directional") return GltfLightType::directional;
    if (light.type != "point") {
        place.fault("type", "E-LIGHT-TYPE", "accepted are point, spot and directional");
    }
    return GltfLightType::point;
}

GltfLight read_light(DocumentReading& reading,
                     const tinygltf::Light& light,
                     const ModelElement& place,
                     size_t index) {
    GltfLight out;
    out.name = name_or(light.name, "light", index);
    out.type = read_light_type(light, place);
    take_numbers(light.color, out.color);
    out.intensity = light.intensity;
    out.range = light.range;
    const bool spot = out.type == GltfLightType::spot;
    if (spot) {
        out.outer_cone_rad = light.spot.outerConeAngle;
        out.inner_cone_rad = light.spot.innerConeAngle;
    }
    for (const NumberEntry<GltfLight>& entry : light_entries)
        clamp_numbers(
            reading, place.pointer() + "/" + entry.place, entry.numbers(out), entry.limits);
    if (spot && out.inner_cone_rad >= out.outer_cone_rad) {
        reading.log.warn(reading.document.at(place.pointer() + "/spot"),
                         "innerConeAngle must be smaller than outerConeAngle; the cone gets a "
                         "sharp edge");
    }
    return out;
}

/// Reads the extensions of a node.
void read_node_extensions(DocumentReading& reading, const ModelElement& node, GltfNode& out) {
    if (node.has_extension(punctual_name)) {
        const size_t light_count = reading.document.lights.size();
        out.light = node.extension(punctual_name).index("light", light_count, "light");
    }
    out.ies = read_node_profile(reading, node);
    out.visible = node.extension("KHR_node_visibility").boolean("visible", true);
    out.lower_levels = node.extension("MSFT_lod").indices("ids", reading.node_count, "node");
    out.instancing = read_instancing(reading, node);
    read_node_shape(reading, node, out);
}

}  // namespace

void read_nodes(DocumentReading& reading) {
    reading.document.nodes.reserve(reading.node_count);
    const auto read = [&](const tinygltf::Node& node, const ModelElement& place, size_t) {
        GltfNode& out = reading.document.nodes.emplace_back();
        out.name = node.name;
        read_transform(reading, node, place, out);
        out.mesh = node.mesh;
        out.weights = node.weights;
        out.camera = node.camera;
        out.skin = node.skin;
        out.children = node.children;
        if (!node.extensions.empty()) read_node_extensions(reading, place, out);
    };
    const auto read_part = [&](const std::vector<tinygltf::Node>& nodes, size_t first) {
        each_element(reading, "nodes", nodes, read, first);
        return !reading.failed();
    };
    Result<void> done = {};
    if (!reading.failed()) {
        done = read_node_parts(std::move(reading.nodes), reading.document.file, read_part);
    }
    if (!done) reading.fault.error = std::move(done.error());
}

void read_scenes(DocumentReading& reading) {
    const auto read = [&](const tinygltf::Scene& scene, const ModelElement& place, size_t index) {
        GltfScene out;
        out.name = name_or(scene.name, "scene", index);
        out.nodes = scene.nodes;
        out.environment =
            place.extension("EXT_lights_image_based")
                .index("light", reading.document.environments.size(), "image-based light");
        reading.document.scenes.push_back(std::move(out));
    };
    each_element(reading, "scenes", reading.model.scenes, read);
    reading.document.scene = reading.model.defaultScene;
}

void read_cameras(DocumentReading& reading) {
    const auto read = [&](const tinygltf::Camera& camera, const ModelElement& place, size_t) {
        const ModelElement lens = place.child(camera.type, camera.extensions);
        GltfCamera out = camera.type == "perspective"
                             ? read_perspective(camera.perspective, lens)
                             : read_orthographic(reading, camera.orthographic, lens);
        out.name = camera.name;
        if (place.has_extension(camera_extension_name)) {
            out.settings = read_camera_extension(place.extension(camera_extension_name));
        }
        reading.document.cameras.push_back(std::move(out));
    };
    each_element(reading, "cameras", reading.model.cameras, read);
}

void read_lights(DocumentReading& reading) {
    each_element(reading,
                 "extensions/KHR_lights_punctual/lights",
                 reading.model.lights,
                 [&](const tinygltf::Light& light, const ModelElement& place, size_t index) {
                     reading.document.lights.push_back(read_light(reading, light, place, index));
                 });
}

}  // namespace obscura::gltf
