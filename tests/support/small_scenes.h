// tests/support/small_scenes.h - glTF files of a few triangles, made in memory, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// Source  RFC 4648, section 4
inline std::string base64(std::string_view bytes) {
    static constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) {
            const size_t at = i + k;
            const auto byte = at < bytes.size() ? static_cast<unsigned char>(bytes[at])
                                                : static_cast<unsigned char>(0);
            group = group << 8 | byte;
        }
        for (size_t k = 0; k < 4; ++k) {
            const bool is_padding = i + k > bytes.size();
            out += is_padding ? '=' : digits[(group >> (18 - 6 * k)) & 63];
        }
    }
    return out;
}

/// A scene's mesh and the parts of the JSON that vary between scenes.
struct SmallScene {
    std::vector<float> positions;          ///< 3 floats a vertex
    std::vector<uint32_t> indices;         ///< 3 a triangle
    std::string nodes = R"({"mesh": 0})";  ///< elements of the array, node 0 first
    std::string roots = "0";               ///< of the only scene
    std::string material = R"("pbrMetallicRoughness": {"metallicFactor": 0}, "doubleSided": true)";
    std::string more;  ///< further top-level members, each with a leading comma
};

/// The .gltf text with its buffer as a data URI.
inline std::string gltf_text(const SmallScene& scene) {
    std::string bytes(scene.positions.size() * 4 + scene.indices.size() * 4, '\0');
    std::memcpy(bytes.data(), scene.positions.data(), scene.positions.size() * 4);
    std::memcpy(
        bytes.data() + scene.positions.size() * 4, scene.indices.data(), scene.indices.size() * 4);
    std::string low;
    std::string high;
    for (size_t c = 0; c < 3; ++c) {
        float least = scene.positions[c];
        float most = scene.positions[c];
        for (size_t i = c; i < scene.positions.size(); i += 3) {
            least = scene.positions[i] < least ? scene.positions[i] : least;
            most = scene.positions[i] > most ? scene.positions[i] : most;
        }
        low += (c == 0 ? "" : ", ") + std::to_string(least);
        high += (c == 0 ? "" : ", ") + std::to_string(most);
    }
    const std::string positions_size = std::to_string(scene.positions.size() * 4);
    const std::string indices_size = std::to_string(scene.indices.size() * 4);
    return R"({"asset": {"version": "2.0", "generator": "obscura tests", "copyright": "CC0"},
"scene": 0, "scenes": [{"name": "Main", "nodes": [)" +
           scene.roots + R"(]}], "nodes": [)" + scene.nodes + R"(],
"meshes": [{"name": "Mesh", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1,
"material": 0}]}], "materials": [{"name": "Paint", )" +
           scene.material + R"(}],
"accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
           std::to_string(scene.positions.size() / 3) + R"(, "min": [)" + low + R"(], "max": [)" +
           high + R"(]},
{"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": )" +
           std::to_string(scene.indices.size()) + R"(}],
"bufferViews": [{"buffer": 0, "byteLength": )" +
           positions_size + R"(}, {"buffer": 0, "byteOffset": )" + positions_size +
           R"(, "byteLength": )" + indices_size + R"(}],
"buffers": [{"byteLength": )" +
           std::to_string(bytes.size()) + R"(, "uri": "data:application/octet-stream;base64,)" +
           base64(bytes) + R"("}])" + scene.more + "}\n";
}

/// One triangle in the plane z = 0; no camera, no light.
inline SmallScene triangle_scene() {
    SmallScene scene;
    scene.positions = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    scene.indices = {0, 1, 2};
    return scene;
}

/// A white square of 2 m in the plane z = 0, lit by a directional light of pi lux along -Z and
/// seen from (0, 0, 3) by the camera "Front"; its radiance is 1 where the light falls.
inline SmallScene lit_quad_scene() {
    SmallScene scene;
    scene.positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    scene.indices = {0, 1, 2, 0, 2, 3};
    scene.nodes = R"({"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]},
{"extensions": {"KHR_lights_punctual": {"light": 0}}})";
    scene.roots = "0, 1, 2";
    scene.material = R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1})";
    scene.more = R"(, "extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"name": "Sun", "type": "directional",
"intensity": 3.14159265}]}},
"cameras": [{"name": "Front", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}])";
    return scene;
}

/// A cube of 2 m at the origin; cameras "Front" (perspective, at (0, 0, 6)), "Top" (orthographic,
/// at (0, 6, 0) looking down) and twice "Twin".
inline SmallScene box_scene() {
    SmallScene scene;
    for (int i = 0; i < 8; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            scene.positions.push_back((i >> axis & 1) != 0 ? 1.0f : -1.0f);
        }
    }
    scene.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    scene.nodes = R"({"mesh": 0}, {"camera": 0, "translation": [0, 0, 6]},
{"camera": 1, "translation": [0, 6, 0], "rotation": [-0.70710678, 0, 0, 0.70710678]},
{"camera": 2, "translation": [0, 0, 8]}, {"camera": 3, "translation": [0, 0, 9]})";
    scene.roots = "0, 1, 2, 3, 4";
    scene.more = R"(, "cameras": [
{"name": "Front", "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1, "zfar": 50}},
{"name": "Top", "type": "orthographic",
"orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 50}},
{"name": "Twin", "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}},
{"name": "Twin", "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}])";
    return scene;
}

}  // namespace obscura
