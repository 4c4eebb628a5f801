// gltf/document_nodes.cpp - reads nodes, scenes, cameras and lights.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/camera_extension.h"
#include "gltf/document_parts.h"
#include "gltf/instancing.h"
#include "gltf/trs.h"
#include "math/warp.h"

#include <cmath>

namespace obscura {

namespace {

constexpr const char* punctual_name = "KHR_lights_punctual";

Affined affine_from_columns(const std::array<double, 16>& columns) {
    Affined out;
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 4; ++c)
            out.m[r][c] = columns[c * 4 + r];
    }
    return out;
}

void read_transform(DocumentReading& reading, const JsonReader& node, GltfNode& out) {
    std::array<double, 16> columns = {};
    const bool t = node.numbers("translation", out.trs.translation);
    const bool r = node.numbers("rotation", out.trs.rotation);
    const bool s = node.numbers("scale", out.trs.scale);
    if (node.numbers("matrix", columns)) {
        if (t || r || s) {
            reading.log.warn(reading.document.at(node.pointer()),
                             "the node has a matrix and a translation, rotation or scale; the "
                             "matrix counts");
        }
        if (columns[3] != 0 || columns[7] != 0 || columns[11] != 0 || columns[15] != 1) {
            reading.log.warn(reading.document.at(node.pointer()),
                             "the matrix's last row is not 0 0 0 1; it is ignored");
        }
        out.has_matrix = true;
        out.parent_from_node = affine_from_columns(columns);
        return;
    }
    if (!normalize_quaternion(out.trs.rotation)) {
        node.fault("rotation", "E-NODE-ROTATION", "the quaternion has no length");
    }
    out.parent_from_node = affine_from_trs(out.trs);
}

GltfCamera read_perspective(const JsonReader& object) {
    GltfCamera out;
    object.require("yfov");
    object.require("znear");
    out.yfov_rad = object.number("yfov", 1);
    out.aspect = object.number("aspectRatio", 0);
    out.znear_m = object.number("znear", 1);
    out.zfar_m = object.number("zfar", 0);
    if (!(out.yfov_rad > 0 && out.yfov_rad < pi_d)) {
        object.fault("yfov", "E-CAM-FOV", "the vertical angle must lie between 0 and pi");
    }
    if (object.has("aspectRatio") && !(out.aspect > 0)) {
        object.fault("aspectRatio", "E-CAM-ASPECT", "the aspect ratio must be above 0");
    }
    if (!(out.znear_m > 0)) object.fault("znear", "E-CAM-CLIP", "znear must be above 0");
    if (object.has("zfar") && !(out.zfar_m > out.znear_m)) {
        object.fault("zfar", "E-CAM-CLIP", "zfar must be larger than znear");
    }
    return out;
}

GltfCamera read_orthographic(DocumentReading& reading, const JsonReader& object) {
    GltfCamera out;
    out.orthographic = true;
    for (const char* key : {"xmag", "ymag", "znear", "zfar"})
        object.require(key);
    out.xmag_m = object.number("xmag", 1);
    out.ymag_m = object.number("ymag", 1);
    out.znear_m = object.number("znear", 0);
    out.zfar_m = object.number("zfar", 1);
    if (out.xmag_m == 0) object.fault("xmag", "E-CAM-MAG", "the magnification must not be 0");
    if (out.ymag_m == 0) object.fault("ymag", "E-CAM-MAG", "the magnification must not be 0");
    if (out.xmag_m < 0 || out.ymag_m < 0) {
        reading.log.warn(reading.document.at(object.pointer()),
                         "a magnification is negative; its absolute value is used");
    }
    out.xmag_m = std::abs(out.xmag_m);
    out.ymag_m = std::abs(out.ymag_m);
    if (!(out.znear_m >= 0)) object.fault("znear", "E-CAM-CLIP", "znear must be 0 or more");
    if (!(out.zfar_m > out.znear_m)) {
        object.fault("zfar", "E-CAM-CLIP", "zfar must be larger than znear");
    }
    return out;
}

void read_spot(DocumentReading& reading, const JsonReader& light, GltfLight& out) {
    const JsonReader spot = light.child("spot");
    constexpr double narrowest = 1e-4;
    out.outer_cone_rad =
        clamped_number(reading, spot, "outerConeAngle", {pi_d / 4, narrowest, pi_d / 2});
    out.inner_cone_rad = clamped_number(reading, spot, "innerConeAngle", {0, 0, pi_d / 2});
    if (out.inner_cone_rad >= out.outer_cone_rad) {
        reading.log.warn(reading.document.at(spot.pointer()),
                         "innerConeAngle must be smaller than outerConeAngle; the cone gets a "
                         "sharp edge");
        out.inner_cone_rad = out.outer_cone_rad;
    }
}

GltfLight read_light(DocumentReading& reading, const JsonReader& light, size_t index) {
    constexpr double largest_range = 1e30;
    GltfLight out;
    out.name = light.text("name");
    if (out.name.empty()) out.name = "light " + std::to_string(index);
    light.require("type");
    const std::string type = light.text("type");
    if (type == "point") {
        out.type = GltfLightType::point;
    } else if (type == "spot") {
        out.type = GltfLightType::spot;
        read_spot(reading, light, out);
    } else if (type == "directional") {
        out.type = GltfLightType::directional;
    } else {
        light.fault("type", "E-LIGHT-TYPE", "accepted are point, spot and directional");
    }
    clamped_numbers(reading, light, "color", out.color, {1, 0, brightest});
    out.intensity = clamped_number(reading, light, "intensity", {1, 0, brightest});
    out.range = light.number("range", 0);
    if (light.has("range") && !(out.range > 0 && out.range <= largest_range)) {
        reading.log.warn(reading.document.at(light.pointer()),
                         "the range must be above 0; it is taken as unlimited");
        out.range = 0;
    }
    return out;
}

/// What extensions say about a node as a whole.
void read_node_extensions(const JsonReader& node, size_t node_count, GltfNode& out) {
    if (!node.has("extensions")) return;
    out.visible = node.extension("KHR_node_visibility").boolean("visible", true);
    out.lower_levels = node.extension("MSFT_lod").indices("ids", node_count, "node");
}

}  // namespace

void read_nodes(DocumentReading& reading) {
    const JsonReader& root = reading.root;
    const size_t node_count = root.count("nodes");
    const size_t mesh_count = root.count("meshes");
    const size_t camera_count = root.count("cameras");
    const size_t light_count = reading.document.lights.size();
    reading.document.nodes.reserve(node_count);
    root.each("nodes", [&](const JsonReader& node, size_t) {
        GltfNode out;
        out.name = node.text("name");
        read_transform(reading, node, out);
        out.mesh = node.index("mesh", mesh_count, "mesh");
        if (reading.root.failed()) return;
        if (out.mesh >= 0) {
            const GltfMesh& mesh = reading.document.meshes[static_cast<size_t>(out.mesh)];
            out.weights = read_morph_weights(node, mesh.target_count);
        }
        out.camera = node.index("camera", camera_count, "camera");
        out.skin = node.index("skin", reading.document.skins.size(), "skin");
        out.children = node.indices("children", node_count, "node");
        if (node.has_extension(punctual_name)) {
            out.light = node.extension(punctual_name).index("light", light_count, "light");
        }
        out.ies = read_node_profile(reading, node);
        read_node_extensions(node, node_count, out);
        out.instancing = read_instancing(reading, node);
        read_node_shape(reading, node, out);
        reading.document.nodes.push_back(std::move(out));
    });
}

void read_scenes(DocumentReading& reading) {
    const size_t node_count = reading.root.count("nodes");
    reading.root.each("scenes", [&](const JsonReader& scene, size_t index) {
        GltfScene out;
        out.name = scene.text("name");
        if (out.name.empty()) out.name = "scene " + std::to_string(index);
        out.nodes = scene.indices("nodes", node_count, "node");
        out.environment =
            scene.extension("EXT_lights_image_based")
                .index("light", reading.document.environments.size(), "image-based light");
        reading.document.scenes.push_back(std::move(out));
    });
    reading.document.scene = reading.root.index("scene", reading.root.count("scenes"), "scene");
}

void read_cameras(DocumentReading& reading) {
    reading.root.each("cameras", [&](const JsonReader& camera, size_t) {
        camera.require("type");
        const std::string type = camera.text("type");
        GltfCamera out;
        if (type == "perspective") {
            camera.require("perspective");
            out = read_perspective(camera.child("perspective"));
        } else if (type == "orthographic") {
            camera.require("orthographic");
            out = read_orthographic(reading, camera.child("orthographic"));
        } else {
            camera.fault("type", "E-CAM-TYPE", "accepted are perspective and orthographic");
        }
        out.name = camera.text("name");
        if (camera.has_extension(camera_extension_name)) {
            out.settings = read_camera_extension(camera.extension(camera_extension_name));
        }
        reading.document.cameras.push_back(std::move(out));
    });
}

void read_lights(DocumentReading& reading) {
    if (!reading.root.has_extension(punctual_name)) return;
    const JsonReader punctual = reading.root.extension(punctual_name);
    punctual.each("lights", [&](const JsonReader& light, size_t index) {
        reading.document.lights.push_back(read_light(reading, light, index));
    });
}

}  // namespace obscura
