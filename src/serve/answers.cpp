// serve/answers.cpp - what the server says, as JSON.
// SPDX-License-Identifier: Apache-2.0
#include "serve/answers.h"

#include "base/setting_names.h"
#include "film/cryptomatte_names.h"

#include <algorithm>

namespace obscura::serve {

namespace {

Json array_of(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

Json camera_of_file(const SceneCamera& camera) {
    const auto& m = camera.world_from_camera.m;
    const auto column = [&](size_t i) { return Vec3d{m[0][i], m[1][i], m[2][i]}; };
    const auto unit = [](const Vec3d& v) { return v * (1 / std::max(length(v), 1e-300)); };
    Json out = {{"name", camera.name},
                {"eye", array_of(column(3))},
                {"forward", array_of(unit(column(2) * -1.0))},
                {"up", array_of(unit(column(1)))}};
    if (camera.type == SceneCameraType::perspective) out["fov"] = camera.yfov_rad * 180 / pi_d;
    return out;
}

Json error_object(const Error& error) {
    const auto plain = [](const std::string& text) {
        return spell_settings(text, SettingNames::plain);
    };
    Json out = {{"id", error.id},
                {"place", plain(error.where)},
                {"text", plain(error.message)},
                {"code", static_cast<int>(error.code)}};
    for (const Error& other : error.also)
        out["also"].push_back(error_object(other));
    return out;
}

}  // namespace

int http_status_of(const Error& error) {
    constexpr int bad_request = 400, unauthorized = 401, forbidden = 403, not_found = 404;
    constexpr int too_large = 413, unprocessable = 422, internal = 500, unavailable = 503;
    constexpr int no_storage = 507;
    if (error.id == "E-SERVE-TOKEN") return unauthorized;
    if (error.id == "E-SERVE-SIZE") return too_large;
    if (error.id == "E-SERVE-BUSY") return unavailable;
    if (error.id.starts_with("E-SERVE-UNKNOWN")) return not_found;
    for (const char* id :
         {"E-SERVE-HOST", "E-SERVE-ORIGIN", "E-SERVE-TYPE", "E-URI-REFUSED", "E-JOB-PATH"}) {
        if (error.id == id) return forbidden;
    }
    if (error.id == "E-SERVE-BODY" || error.id == "E-SERVE-REQUEST") return bad_request;
    switch (error.code) {
        case ExitCode::usage:
            return bad_request;
        case ExitCode::missing_scene:
            return not_found;
        case ExitCode::out_of_memory:
            return no_storage;
        case ExitCode::internal:
        case ExitCode::cannot_create:
        case ExitCode::io_error:
            return internal;
        default:
            return unprocessable;
    }
}

int simple_status_of(const Error& error) {
    constexpr int bad_request = 400, internal = 500;
    for (const char* id : {"E-SERVE-TOKEN", "E-SERVE-HOST", "E-SERVE-ORIGIN", "E-SERVE-SIZE"}) {
        if (error.id == id) return http_status_of(error);
    }
    if (error.id == "E-OIIO" || error.id == "E-ISA") return internal;
    switch (error.code) {
        case ExitCode::usage:
        case ExitCode::bad_data:
        case ExitCode::missing_scene:
        case ExitCode::bad_resource:
        case ExitCode::unsupported:
        case ExitCode::refused:
        case ExitCode::configuration:
            return bad_request;
        default:
            return internal;
    }
}

void replace_path(std::string& text, const std::filesystem::path& file, const std::string& name) {
    const std::string path = file.string();
    for (size_t at = 0; (at = text.find(path, at)) != std::string::npos; at += name.size())
        text.replace(at, path.size(), name);
}

Error with_name(Error error, const std::filesystem::path& file, const std::string& name) {
    replace_path(error.where, file, name);
    replace_path(error.message, file, name);
    for (Error& other : error.also)
        other = with_name(std::move(other), file, name);
    return error;
}

std::string error_text(const Error& error) {
    constexpr size_t longest = 4000;
    std::string out;
    const auto add = [&](const Error& one) {
        if (out.size() > longest) return;
        out += one.id + " " + spell_settings(one.where, SettingNames::plain) + ": " +
               spell_settings(one.message, SettingNames::plain) + "\n";
    };
    add(error);
    for (const Error& other : error.also)
        add(other);
    return out.substr(0, 2 * longest);
}

Json error_answer(const Error& error) {
    return {{"error", error_object(error)}};
}

Json asset_answer(const Scene& scene, const std::vector<std::string>& warnings) {
    const AssetInfo& info = scene.info;
    Json out = {{"name", info.file_name},
                {"triangles", info.triangles_in_world},
                {"is_empty", scene.bounds.empty()},
                {"scenes", info.scenes},
                {"variants", info.variants},
                {"nodes", node_paths(info)},
                {"warnings", warnings},
                {"cameras", Json::array()},
                {"animations", Json::array()}};
    if (!scene.bounds.empty()) {
        const Vec3f &low = scene.bounds.low, &high = scene.bounds.high;
        out["low"] = array_of({low.x, low.y, low.z});
        out["high"] = array_of({high.x, high.y, high.z});
    }
    for (const SceneCamera& camera : scene.cameras)
        out["cameras"].push_back(camera_of_file(camera));
    for (const AnimationInfo& animation : info.animations)
        out["animations"].push_back({{"name", animation.name}, {"end_s", animation.end_s}});
    return out;
}

Json camera_answer(const LookAt& camera) {
    return {{"eye", array_of(camera.eye_m)},
            {"target", array_of(camera.target_m)},
            {"up", array_of(camera.up)},
            {"fov", camera.yfov_rad * 180 / pi_d}};
}

Json pick_answer(const Pick& pick) {
    if (pick.node.empty()) return {{"node", nullptr}};
    return {{"node", pick.node},
            {"material", pick.material},
            {"distance_m", pick.distance_m},
            {"point", array_of(pick.point_m)}};
}

std::string image_header(const ShownImage& picture) {
    return json_line({{"serial", picture.serial},
                      {"wish", picture.wish},
                      {"width", picture.image.width},
                      {"height", picture.image.height},
                      {"channels", picture.image.channels},
                      {"samples", picture.samples},
                      {"of", picture.of},
                      {"done", picture.is_done},
                      {"denoised", picture.is_denoised},
                      {"seconds", picture.seconds}});
}

}  // namespace obscura::serve
