// tests/serve/drake_scene.h - a scene as Drake sends it, and what its pixels show by formulas.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/small_scenes.h"
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace obscura::drake_scene {

/// The world's up is +Z; the camera stands there and looks along +Y.
inline constexpr double eye_y = -3, eye_z = 0.5;

/// A rectangle that is upright or leans back: its sides are parallel to the image's.
struct Wall {
    double left, right;    ///< x
    double low, high;      ///< z
    double near_y, slope;  ///< y = near_y + slope * (z - low)
    int label;

    double y_at(double z) const { return near_y + slope * (z - low); }
};

/// The first one leans, and hides a part of the second one.
inline constexpr std::array<Wall, 2> walls = {
    {{-1.02, 0.217, -0.513, 1.193, 0.5, 0.6, 5}, {0.03, 1.541, -0.307, 1.011, 2, 0, 300}}};

/// As Drake's CameraInfo: the principal point is not in the middle.
struct Lens {
    int width = 64, height = 48;
    double fx = 70, fy = 60, cx = 20.3, cy = 30.6;
};

struct Seen {
    double depth_m = 0;
    int wall = -1;
};

/// What a pixel's middle sees: the point of the ray whose depth is 1 is (x, 1, z) ahead of the eye.
inline Seen seen_at(const Lens& lens, int column, int row) {
    const double x = (column + 0.5 - lens.cx) / lens.fx;
    const double z = (lens.cy - row - 0.5) / lens.fy;
    Seen out;
    for (size_t i = 0; i < walls.size(); ++i) {
        const Wall& wall = walls[i];
        // eye_y + d = near_y + slope (eye_z + d z - low)
        const double depth = (wall.y_at(eye_z) - eye_y) / (1 - wall.slope * z);
        const double at_x = depth * x, at_z = eye_z + depth * z;
        const bool is_hit = depth > 0 && at_x > wall.left && at_x < wall.right && at_z > wall.low &&
                            at_z < wall.high;
        if (is_hit && (out.wall < 0 || depth < out.depth_m)) out = {depth, static_cast<int>(i)};
    }
    return out;
}

/// The column and row of a point, as fractions.
inline std::array<double, 2> projected(const Lens& lens, double x, double y, double z) {
    const double depth = y - eye_y;
    return {lens.cx + lens.fx * x / depth, lens.cy - lens.fy * (z - eye_z) / depth};
}

struct Parts {
    nlohmann::json accessors = nlohmann::json::array();
    nlohmann::json views = nlohmann::json::array();
    nlohmann::json buffers = nlohmann::json::array();

    /// A buffer, a view and an accessor for each array, as VTK writes them.
    int add(std::string bytes, nlohmann::json&& accessor) {
        const auto index = static_cast<int>(accessors.size());
        buffers.push_back({{"byteLength", bytes.size()},
                           {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
        views.push_back({{"buffer", index}, {"byteLength", bytes.size()}});
        accessor["bufferView"] = index;
        accessors.push_back(std::move(accessor));
        return index;
    }
};

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
    std::string out(values.size() * sizeof(T), '\0');
    std::memcpy(out.data(), values.data(), out.size());
    return out;
}

inline nlohmann::json mesh_of(const Wall& wall, int material, Parts& parts) {
    const auto f = [](double value) { return static_cast<float>(value); };
    const float front = f(wall.near_y), back = f(wall.y_at(wall.high));
    const std::vector<float> positions = {f(wall.left),
                                          front,
                                          f(wall.low),
                                          f(wall.right),
                                          front,
                                          f(wall.low),
                                          f(wall.right),
                                          back,
                                          f(wall.high),
                                          f(wall.left),
                                          back,
                                          f(wall.high)};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    const int at = parts.add(bytes_of(positions),
                             {{"componentType", 5126},
                              {"type", "VEC3"},
                              {"count", 4},
                              {"min", {positions[0], front, positions[2]}},
                              {"max", {positions[3], std::max(front, back), positions[8]}}});
    const int order =
        parts.add(bytes_of(indices), {{"componentType", 5125}, {"type", "SCALAR"}, {"count", 6}});
    const nlohmann::json primitive = {
        {"attributes", {{"POSITION", at}}}, {"indices", order}, {"material", material}};
    return {{"primitives", {primitive}}};
}

/// The walls in the colours of their labels; with other nodes where the test needs some.
inline std::string gltf(bool has_camera = true) {
    Parts parts;
    nlohmann::json meshes = nlohmann::json::array(), materials = nlohmann::json::array();
    for (size_t i = 0; i < walls.size(); ++i) {
        const int label = walls[i].label;
        const nlohmann::json color = {(label & 255) / 255.0, (label >> 8) / 255.0, 0.0, 1.0};
        materials.push_back(
            {{"pbrMetallicRoughness",
              {{"baseColorFactor", color}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}});
        meshes.push_back(mesh_of(walls[i], static_cast<int>(i), parts));
    }
    nlohmann::json nodes = {{{"mesh", 0}}, {{"mesh", 1}}};
    nlohmann::json children = {0, 1};
    nlohmann::json out = {{"asset", {{"version", "2.0"}, {"generator", "VTK"}}},
                          {"scene", 0},
                          {"meshes", meshes},
                          {"materials", materials},
                          {"accessors", parts.accessors},
                          {"bufferViews", parts.views},
                          {"buffers", parts.buffers}};
    if (has_camera) {
        const nlohmann::json pose = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, eye_y, eye_z, 1};
        nodes.push_back({{"camera", 0}, {"name", "Camera Node"}, {"matrix", pose}});
        children.push_back(2);
        const nlohmann::json lens = {
            {"aspectRatio", 1.25}, {"yfov", 0.7}, {"znear", 0.01}, {"zfar", 10.0}};
        out["cameras"] = {{{"type", "perspective"}, {"perspective", lens}}};
    }
    const auto root = nodes.size();
    nodes.push_back({{"name", "Renderer Node"}, {"children", children}});
    out["nodes"] = nodes;
    out["scenes"] = {{{"nodes", {root}}}};
    return out.dump(1);
}

}  // namespace obscura::drake_scene
