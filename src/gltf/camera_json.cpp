// gltf/camera_json.cpp - reads a computer vision camera (intrinsics, extrinsics) from JSON.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/camera_json.h"

#include "base/json/json_file.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>

namespace obscura::gltf {

namespace {

using nlohmann::json;

constexpr const char* value_id = "E-CAM-VALUE";
constexpr uint64_t largest_file = 1 << 20;

constexpr std::array<std::string_view, 16> known_keys = {"name",
                                                         "model",
                                                         "width",
                                                         "height",
                                                         "fx",
                                                         "fy",
                                                         "cx",
                                                         "cy",
                                                         "K",
                                                         "pixel_center",
                                                         "distortion",
                                                         "fov",
                                                         "R",
                                                         "t",
                                                         "world_to_camera",
                                                         "camera_to_world"};

/// A flat or nested array of exactly `out.size()` numbers; false when absent or wrong.
bool read_matrix(const JsonReader& reader,
                 const json& tree,
                 const char* key,
                 std::vector<double>& out) {
    if (!reader.has(key)) return false;
    std::vector<double> numbers;
    const auto gather_numbers = [&](const json& list, auto&& self, int depth) -> bool {
        return list.is_array() && depth < 2 &&
               std::all_of(list.begin(), list.end(), [&](const json& element) {
                   if (!element.is_number()) return self(element, self, depth + 1);
                   numbers.push_back(element.get<double>());
                   return true;
               });
    };
    if (!gather_numbers(tree.at(key), gather_numbers, 0) || numbers.size() != out.size()) {
        reader.fault(key,
                     value_id,
                     "expected " + std::to_string(out.size()) +
                         " numbers, row by row, flat or as "
                         "an array of rows");
        return false;
    }
    out = std::move(numbers);
    return true;
}

double positive(const JsonReader& reader, const char* key) {
    reader.require(key);
    const double value = reader.number(key, 1);
    if (!(value > 0 && value < 1e9)) reader.fault(key, value_id, "expected a number above 0");
    return value;
}

Intrinsics read_intrinsics(const JsonReader& reader,
                           const json& tree,
                           std::optional<std::array<int, 2>> size_px) {
    Intrinsics out;
    const std::array<int, 2> fallback = size_px.value_or(std::array{1, 1});
    for (const auto& [key, side, otherwise] : {std::tuple{"width", &out.width_px, fallback[0]},
                                               std::tuple{"height", &out.height_px, fallback[1]}}) {
        if (!size_px) reader.require(key);
        const uint64_t pixels = reader.size(key, static_cast<uint64_t>(otherwise));
        if (pixels < 1 || pixels > 65536) {
            reader.fault(key, value_id, "expected a whole number from 1 to 65536");
        }
        *side = static_cast<double>(pixels);
    }
    constexpr double max_pixels = 536870912;
    if (out.width_px * out.height_px > max_pixels) {
        reader.fault("height", value_id, "expected at most 536870912 pixels in all");
    }
    std::vector<double> k(9);
    if (read_matrix(reader, tree, "K", k)) {
        if (!(k[0] > 0 && k[4] > 0) || k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 ||
            k[8] != 1) {
            reader.fault("K", value_id, "expected fx 0 cx, 0 fy cy, 0 0 1 with fx, fy above 0");
        }
        out.fx_px = k[0];
        out.fy_px = k[4];
        out.cx_px = k[2];
        out.cy_px = k[5];
    } else {
        out.fx_px = positive(reader, "fx");
        out.fy_px = positive(reader, "fy");
        out.cx_px = reader.number("cx", out.width_px / 2);
        out.cy_px = reader.number("cy", out.height_px / 2);
    }
    // Position of the first pixel's centre: 0.5 when counted from the image's corner.
    const double centre = reader.number("pixel_center", 0.5);
    if (centre != 0 && centre != 0.5) {
        reader.fault("pixel_center", value_id, "expected 0.5 or 0: the first pixel's coordinates");
    }
    const bool counts_centres = centre == 0 && (reader.has("cx") || reader.has("K"));
    out.cx_px += counts_centres ? 0.5 : 0;
    out.cy_px += counts_centres ? 0.5 : 0;
    return out;
}

void read_model(const JsonReader& reader, const json& tree, CameraSettings& out) {
    const std::string model = reader.text("model", "pinhole");
    if (model != "pinhole" && model != "fisheye") {
        reader.fault("model", value_id, "expected pinhole or fisheye");
    }
    if (model == "fisheye") {
        out.model = CameraModel::fisheye;
        out.fisheye = FisheyeLaw::opencv;
        std::vector<double> k(4);
        out.fisheye_k.emplace();
        if (read_matrix(reader, tree, "distortion", k)) {
            std::copy_n(k.begin(), 4, out.fisheye_k->begin());
        }
        if (reader.has("fov")) {
            const double degrees = reader.number("fov", 180);
            if (!(degrees > 0 && degrees <= 360)) {
                reader.fault("fov", value_id, "expected degrees above 0, up to 360");
            }
            out.fisheye_fov_rad = degrees * pi_d / 180;
        }
        return;
    }
    out.model = CameraModel::pinhole;
    if (reader.has("fov")) reader.fault("fov", value_id, "it is for the model fisheye only");
    const bool four = reader.count("distortion") == 4;
    std::vector<double> k(four ? 4 : 5);
    if (read_matrix(reader, tree, "distortion", k)) {
        out.distortion.emplace();
        out.distortion->fill(0);
        std::copy(k.begin(), k.end(), out.distortion->begin());
    }
}

/// Rows of 4 numbers, 3 or 4 of them.
bool read_pose(const JsonReader& reader, const json& tree, const char* key, Affined& out) {
    const bool nested = reader.count(key) == 3 || reader.count(key) == 12;
    std::vector<double> m(nested ? 12 : 16);
    if (!read_matrix(reader, tree, key, m)) return false;
    for (size_t i = 0; i < 12; ++i)
        out.m[i / 4][i % 4] = m[i];
    if (!is_rotation(out)) {
        reader.fault(key, "E-CAM-MATRIX", "its 3x3 part is not a rotation");
    }
    return true;
}

/// world_from_camera with our axes: +Y up, looking down -Z.
Affined read_place(const JsonReader& reader, const json& tree) {
    Affined camera_from_world;
    Affined world_from_camera;
    const bool given = reader.has("camera_to_world");
    if (given + reader.has("world_to_camera") + (reader.has("R") || reader.has("t")) > 1) {
        reader.fault("", value_id, "expected one of: R with t, world_to_camera, camera_to_world");
    }
    if (!given && !read_pose(reader, tree, "world_to_camera", camera_from_world)) {
        std::vector<double> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        std::vector<double> translation(3);
        read_matrix(reader, tree, "R", rotation);
        read_matrix(reader, tree, "t", translation);
        for (size_t i = 0; i < 9; ++i)
            camera_from_world.m[i / 3][i % 3] = rotation[i];
        for (size_t i = 0; i < 3; ++i)
            camera_from_world.m[i][3] = translation[i];
        if (!is_rotation(camera_from_world)) {
            reader.fault("R", "E-CAM-MATRIX", "it is not a rotation");
        }
    }
    if (given) {
        read_pose(reader, tree, "camera_to_world", world_from_camera);
    } else if (!reader.failed()) {
        world_from_camera = inverse(camera_from_world);
    }
    for (auto& row : world_from_camera.m) {
        row[1] = -row[1];
        row[2] = -row[2];
    }
    return world_from_camera;
}

}  // namespace

bool is_rotation(const Affined& a) {
    constexpr double tolerance = 1e-3;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            double sum = 0;
            for (const auto& row : a.m)
                sum += row[i] * row[j];
            if (!(std::abs(sum - (i == j ? 1 : 0)) < tolerance)) return false;
        }
    }
    return determinant(a) > 0;
}

Result<SceneCamera> load_camera_json(const std::filesystem::path& file, Log& log) {
    const Result<json> tree = read_json_file(
        file,
        largest_file,
        {ExitCode::bad_resource, "E-CAMJSON-MISSING", file.string(), "the camera's file"},
        log);
    if (!tree) return fail(tree.error());
    JsonFault fault;
    fault.file = file.string();
    const JsonReader reader(*tree, "", fault);
    check_known_keys(reader, known_keys, "E-CAM-KEY");
    SceneCamera camera = read_camera(reader, *tree, {});
    camera.name = file.filename().string();
    if (fault.error) return fail(std::move(*fault.error));
    return camera;
}

SceneCamera read_camera(const JsonReader& reader,
                        const json& tree,
                        std::optional<std::array<int, 2>> size_px) {
    SceneCamera camera;
    camera.settings.intrinsics = read_intrinsics(reader, tree, size_px);
    read_model(reader, tree, camera.settings);
    camera.world_from_camera = read_place(reader, tree);
    return camera;
}

bool has_camera_keys(const JsonReader& reader) {
    constexpr std::array keys = {"model",
                                 "fx",
                                 "fy",
                                 "cx",
                                 "cy",
                                 "K",
                                 "R",
                                 "t",
                                 "world_to_camera",
                                 "camera_to_world",
                                 "distortion",
                                 "pixel_center"};
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return reader.has(key); });
}

}  // namespace obscura::gltf
