// session/views_file.cpp - reads the views of --views from JSON.
// SPDX-License-Identifier: Apache-2.0
#include "session/views_file.h"

#include "base/json/json_file.h"
#include "gltf/camera_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace obscura {

namespace {

using nlohmann::json;

constexpr const char* value_id = "E-VIEWS-VALUE";
constexpr uint64_t largest_file = 256U << 20;
constexpr double degree = pi_d / 180;
constexpr uint64_t max_side_px = 65536;
constexpr int64_t max_pixels = int64_t{1} << 29;

constexpr std::array<std::string_view, 28> known_keys = {"name",
                                                         "camera",
                                                         "eye",
                                                         "target",
                                                         "up",
                                                         "fov",
                                                         "azimuth",
                                                         "elevation",
                                                         "roll",
                                                         "zoom",
                                                         "model",
                                                         "width",
                                                         "height",
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
                                                         "pixel_center",
                                                         "variant",
                                                         "time",
                                                         "environment_rotation",
                                                         "environment_intensity"};

/// A number in a range; nothing where the key is absent.
std::optional<double> number_in(const JsonReader& reader,
                                const char* key,
                                double least,
                                double most) {
    if (!reader.has(key)) return {};
    const double value = reader.number(key, least);
    if (!(value >= least && value <= most)) {
        reader.fault(
            key,
            value_id,
            "expected a number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return value;
}

std::optional<Vec3d> read_vector(const JsonReader& reader, const char* key) {
    std::array<double, 3> numbers = {};
    if (!reader.numbers(key, numbers)) return {};
    return Vec3d{numbers[0], numbers[1], numbers[2]};
}

std::optional<std::array<int, 2>> read_size(const JsonReader& reader) {
    if (!reader.has("width") && !reader.has("height")) return {};
    reader.require("width");
    reader.require("height");
    std::array<int, 2> out = {1, 1};
    for (const auto& [key, side] : {std::pair{"width", &out[0]}, std::pair{"height", &out[1]}}) {
        const uint64_t pixels = reader.size(key, 1);
        if (pixels >= 1 && pixels <= max_side_px) {
            *side = static_cast<int>(pixels);
        } else {
            reader.fault(key, value_id, "expected a whole number from 1 to 65536");
        }
    }
    if (int64_t{1} * out[0] * out[1] > max_pixels)
        reader.fault("height", value_id, "expected at most 536870912 pixels in all");
    return out;
}

/// How many of the ways to place a camera a view uses: it may be one.
int count_ways(const JsonReader& reader) {
    const auto has_any = [&](std::initializer_list<const char*> keys) {
        return std::any_of(
            keys.begin(), keys.end(), [&](const char* key) { return reader.has(key); });
    };
    return int{reader.has("camera")} + int{has_any({"eye", "target", "up"})} +
           int{has_any({"azimuth", "elevation", "roll", "zoom"})} +
           int{gltf::has_camera_keys(reader)};
}

void read_framing(const JsonReader& reader, CameraRequest& out) {
    constexpr double max_turn_deg = 36000;
    FramingOptions& framing = out.framing;
    const auto angle = [&](const char* key, double most, double& to) {
        const auto degrees = number_in(reader, key, -most, most);
        if (!degrees) return;
        to = *degrees * degree;
        out.frames = true;
    };
    angle("azimuth", max_turn_deg, framing.azimuth_rad);
    angle("elevation", 90, framing.elevation_rad);
    angle("roll", max_turn_deg, framing.roll_rad);
    if (const auto zoom = number_in(reader, "zoom", 0.01, 1000)) {
        framing.zoom = *zoom;
        out.frames = true;
    }
}

/// Where a view is seen from, over what the request says; a view that says so takes the place of
/// all of the request's ways.
void read_place(const JsonReader& reader,
                const json& tree,
                View& view,
                const RenderRequest& whole) {
    CameraRequest& camera = view.camera;
    const int ways = count_ways(reader);
    if (ways > 1) {
        reader.fault("",
                     value_id,
                     "expected one of: camera; eye, target, up; azimuth, elevation, roll, zoom; "
                     "intrinsics with R and t or a matrix");
    }
    if (ways > 0) {
        camera.loaded.reset();
        camera.choice.clear();
        camera.eye_m = camera.target_m = camera.up = {};
        camera.frames = false;
    }
    if (reader.has("camera")) camera.choice = reader.text("camera");
    if (const auto eye = read_vector(reader, "eye")) camera.eye_m = eye;
    if (const auto target = read_vector(reader, "target")) camera.target_m = target;
    if (const auto up = read_vector(reader, "up")) camera.up = up;
    read_framing(reader, camera);
    if (gltf::has_camera_keys(reader)) {
        const std::array<int, 2> size = {whole.options.width, whole.options.height};
        camera.loaded = gltf::read_camera(reader, tree, view.size_px.value_or(size));
        camera.loaded->name = "view '" + view.name + "'";
    } else if (const auto fov = number_in(reader, "fov", 0.01, 179.99)) {
        camera.yfov_rad = *fov * degree;
    }
}

View read_view(const JsonReader& reader,
               const json& tree,
               size_t index,
               const RenderRequest& whole) {
    check_known_keys(reader, known_keys, "E-VIEWS-KEY");
    View view{reader.text("name", "view " + std::to_string(index)), whole.camera};
    view.size_px = read_size(reader);
    read_place(reader, tree, view, whole);
    if (reader.has("variant")) view.variant = reader.text("variant");
    view.time_s = number_in(reader, "time", 0, 1e6);
    view.environment_rotation_deg = number_in(reader, "environment_rotation", -36000, 36000);
    view.environment_intensity = number_in(reader, "environment_intensity", 0, 1e6);
    json text = tree;
    text.erase("name");
    view.text = text.dump();
    view.place = whole.lists.views_file->string() + "#" + reader.pointer();
    reader.each_key([&](const std::string& key) { view.keys.push_back(key); });
    return view;
}

/// Animations play for all views or for none, and a sequence has times of its own.
void check_times(const JsonReader& reader,
                 const std::vector<View>& views,
                 const RenderRequest& whole) {
    const auto has_time = [](const View& view) { return view.time_s.has_value(); };
    if (std::none_of(views.begin(), views.end(), has_time)) return;
    if (whole.frames) {
        reader.fault("views", value_id, "with --frames the frames tell the time; leave it out");
    } else if (!whole.load.time_s && !std::all_of(views.begin(), views.end(), has_time)) {
        reader.fault("views",
                     value_id,
                     "some views have a time and some have none; give all one, or --time for the "
                     "others");
    }
}

}  // namespace

Result<void> load_views(RenderRequest& request, Log& log) {
    if (!request.lists.views_file) return {};
    const std::filesystem::path& file = *request.lists.views_file;
    const Result<json> tree = read_json_file(
        file,
        largest_file,
        {ExitCode::bad_resource, "E-VIEWS-MISSING", file.string(), "the file of views"},
        log);
    if (!tree) return fail(tree.error());
    JsonFault fault;
    fault.file = file.string();
    const JsonReader reader(*tree, "", fault);
    reader.require("views");
    std::vector<View> views;
    reader.each("views", [&](const JsonReader& one, size_t index) {
        views.push_back(read_view(one, tree->at("views").at(index), index, request));
    });
    if (views.empty()) reader.fault("views", value_id, "expected one view at least");
    check_times(reader, views, request);
    if (fault.error) return fail(std::move(*fault.error));
    request.lists.views = std::make_shared<const std::vector<View>>(std::move(views));
    return {};
}

}  // namespace obscura
