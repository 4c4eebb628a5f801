// tests/camera/camera_models.h - one camera of each kind, all at one position, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/project.h"

#include <cmath>
#include <string>
#include <vector>

namespace obscura::test {

inline constexpr int film_width = 640;
inline constexpr int film_height = 480;

struct NamedCamera {
    std::string name;
    Camera camera;
};

inline Vec3d widen(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

/// A pose without right angles.
inline Affinef some_place() {
    const double a = 0.7;
    const double b = -0.4;
    const Affined yaw{
        {{std::cos(a), 0, std::sin(a), 3}, {0, 1, 0, -2}, {-std::sin(a), 0, std::cos(a), 5}}};
    const Affined pitch{
        {{1, 0, 0, 0}, {0, std::cos(b), -std::sin(b), 0}, {0, std::sin(b), std::cos(b), 0}}};
    return affine_cast<float>(compose(yaw, pitch));
}

inline Camera pinhole_camera() {
    Camera camera;
    camera.world_from_camera = some_place();
    camera.pinhole.tan_half_yfov = 0.5f;
    camera.pinhole.aspect = static_cast<float>(film_width) / film_height;
    camera.pinhole.pixel_spread = 1.0f / film_height;
    return camera;
}

/// A fisheye whose circle touches the image's upper and lower edge.
inline Camera fisheye_camera(FisheyeLaw law, double fov_deg, const double (&k)[4]) {
    Camera camera;
    camera.model = CameraModel::fisheye;
    camera.world_from_camera = some_place();
    FisheyeCamera& f = camera.fisheye;
    f.law = law;
    for (int i = 0; i < 4; ++i)
        f.k[i] = static_cast<float>(k[i]);
    f.largest_angle = static_cast<float>(fov_deg / 360 * pi_d);
    f.largest_radius = fisheye_radius(f, f.largest_angle);
    f.half_height = f.largest_radius;
    f.half_width = f.largest_radius * film_width / film_height;
    f.pixel_spread = 2 * f.half_height / film_height;
    return camera;
}

inline constexpr double no_k[4] = {0, 0, 0, 0};
inline constexpr double some_k[4] = {-0.02, 0.004, -0.0015, 0.0001};

inline Camera environment_camera(EnvironmentProjection projection) {
    Camera camera;
    camera.model = CameraModel::environment;
    camera.world_from_camera = some_place();
    camera.environment.projection = projection;
    camera.environment.half_height = 0.8f;
    camera.environment.cube_columns = 3;
    camera.environment.pixel_width = static_cast<float>(2 * pi_d / film_width);
    camera.environment.pixel_height = static_cast<float>(pi_d / film_height);
    return camera;
}

inline std::vector<NamedCamera> all_cameras() {
    std::vector<NamedCamera> out = {{"pinhole", pinhole_camera()}};
    out.push_back({"shifted", pinhole_camera()});
    out.back().camera.pinhole.shift_x = 0.3f;
    out.back().camera.pinhole.shift_y = -0.2f;
    out.push_back({"thin lens", pinhole_camera()});
    out.back().camera.model = CameraModel::thin_lens;
    out.back().camera.thin_lens.aperture.radius_m = 0.1f;
    out.back().camera.thin_lens.inverse_focus = 0.25f;
    out.push_back({"distorted", pinhole_camera()});
    out.back().camera.distortion = {-0.2f, 0.05f, 0.002f, -0.003f, -0.004f, 0};
    out.back().camera.distortion.radius_limit =
        static_cast<float>(largest_radius(-0.2, 0.05, -0.004, 100));
    out.push_back({"orthographic", pinhole_camera()});
    out.back().camera.model = CameraModel::orthographic;
    out.back().camera.orthographic = {4, 3, 6.0f / film_height};
    for (const double fov : {180.0, 220.0}) {
        const std::string degrees = " " + std::to_string(static_cast<int>(fov));
        out.push_back(
            {"equidistant" + degrees, fisheye_camera(FisheyeLaw::equidistant, fov, no_k)});
        out.push_back({"equisolid" + degrees, fisheye_camera(FisheyeLaw::equisolid, fov, no_k)});
        out.push_back(
            {"stereographic" + degrees, fisheye_camera(FisheyeLaw::stereographic, fov, no_k)});
        out.push_back({"opencv" + degrees, fisheye_camera(FisheyeLaw::opencv, fov, some_k)});
    }
    out.push_back({"equidistant 360", fisheye_camera(FisheyeLaw::equidistant, 360, no_k)});
    out.push_back({"orthographic fisheye", fisheye_camera(FisheyeLaw::orthographic, 170, no_k)});
    out.push_back({"latlong", environment_camera(EnvironmentProjection::latlong)});
    out.push_back({"cylinder", environment_camera(EnvironmentProjection::cylindrical)});
    out.push_back({"cube", environment_camera(EnvironmentProjection::cubemap)});
    out.push_back({"two eyes", environment_camera(EnvironmentProjection::latlong)});
    out.back().camera.environment.half_eyes_m = 0.03f;
    return out;
}

}  // namespace obscura::test
