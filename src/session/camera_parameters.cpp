// session/camera_parameters.cpp - describes a camera's settings in an image's header.
// SPDX-License-Identifier: Apache-2.0
#include "session/camera_parameters.h"

#include "camera/names.h"
#include "math/warp.h"

#include <cmath>
#include <fmt/format.h>

namespace obscura {

namespace {

void add(std::string& text, const char* name, double value) {
    text += fmt::format("{}{}={:.7g}", text.empty() ? "" : " ", name, value);
}

void add(std::string& text, const char* name, const char* value) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
}

void add_film(const PinholeCamera& film, std::string& text) {
    const auto half_height = static_cast<double>(film.tan_half_yfov);
    add(text, "yfov_deg", 2 * std::atan(half_height) / radians_per_degree);
    add(text, "film_aspect", static_cast<double>(film.aspect));
    if (film.shift_x == 0 && film.shift_y == 0) return;
    add(text,
        "shift_x",
        static_cast<double>(film.shift_x) / (2 * half_height * static_cast<double>(film.aspect)));
    add(text, "shift_y", static_cast<double>(film.shift_y) / (2 * half_height));
}

void add_distortion(const Distortion& d, std::string& text) {
    if (!(d.radius_limit > 0)) return;
    text +=
        fmt::format(" distortion={:.7g},{:.7g},{:.7g},{:.7g},{:.7g}", d.k1, d.k2, d.p1, d.p2, d.k3);
}

void add_lens(const ThinLens& lens, std::string& text) {
    add(text, "lens_radius_m", static_cast<double>(lens.aperture.radius_m));
    add(text, "focus_distance_m", 1 / static_cast<double>(lens.inverse_focus));
    if (lens.aperture.blades > 0) add(text, "blades", lens.aperture.blades);
    if (lens.aperture.rotation_turns != 0) {
        add(text, "blade_rotation_deg", static_cast<double>(lens.aperture.rotation_turns) * 360);
    }
    if (lens.aperture.squeeze != 1) {
        add(text, "anamorphic", 1 / static_cast<double>(lens.aperture.squeeze));
    }
}

void add_fisheye(const FisheyeCamera& camera, std::string& text) {
    add(text, "fisheye", name_of(fisheye_law_names, camera.law));
    add(text, "fov_deg", 2 * static_cast<double>(camera.largest_angle) / radians_per_degree);
    add(text, "half_width", static_cast<double>(camera.half_width));
    add(text, "half_height", static_cast<double>(camera.half_height));
    if (camera.shift_x != 0 || camera.shift_y != 0) {
        add(text, "shift_x", static_cast<double>(camera.shift_x / (2 * camera.half_width)));
        add(text, "shift_y", static_cast<double>(camera.shift_y / (2 * camera.half_height)));
    }
    if (camera.law != FisheyeLaw::opencv) return;
    text += fmt::format(
        " k={:.7g},{:.7g},{:.7g},{:.7g}", camera.k[0], camera.k[1], camera.k[2], camera.k[3]);
}

void add_environment(const EnvironmentCamera& camera, std::string& text) {
    add(text, "environment", name_of(environment_projection_names, camera.projection));
    if (camera.projection == EnvironmentProjection::cylindrical) {
        add(text,
            "yfov_deg",
            2 * std::atan(static_cast<double>(camera.half_height)) / radians_per_degree);
    }
    if (camera.half_eyes_m > 0) {
        add(text, "stereo_m", 2 * static_cast<double>(camera.half_eyes_m));
    }
}

}  // namespace

std::string camera_parameters(const Camera& camera) {
    std::string text;
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            add_film(camera.pinhole, text);
            add_distortion(camera.distortion, text);
            if (camera.model == CameraModel::thin_lens) add_lens(camera.thin_lens, text);
            break;
        case CameraModel::orthographic:
            add(text, "xmag_m", static_cast<double>(camera.orthographic.half_width_m));
            add(text, "ymag_m", static_cast<double>(camera.orthographic.half_height_m));
            break;
        case CameraModel::fisheye:
            add_fisheye(camera.fisheye, text);
            break;
        case CameraModel::environment:
            add_environment(camera.environment, text);
            break;
    }
    if (camera.near_m > 0) add(text, "near_m", static_cast<double>(camera.near_m));
    if (camera.far_m > 0) add(text, "far_m", static_cast<double>(camera.far_m));
    return text;
}

}  // namespace obscura
