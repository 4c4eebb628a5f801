// camera/project.cpp - projects a world position to the film: the inverse of generate_ray.
// SPDX-License-Identifier: Apache-2.0
#include "camera/project.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

using Film = std::optional<Vec2<double>>;

Film project_flat(const Camera& camera, const Vec3d& p) {
    if (!(p.z < 0)) return std::nullopt;
    Vec2<double> plane{p.x / -p.z, p.y / -p.z};
    if (is_distorted(camera)) {
        const double limit = static_cast<double>(camera.distortion.radius_limit);
        if (std::hypot(plane.x, plane.y) > limit) return std::nullopt;
        const Vec2<double> position =
            distort(camera.distortion, Vec2<double>{plane.x, -plane.y}).position;
        plane = {position.x, -position.y};
    }
    return film_from_plane(camera.pinhole, plane);
}

Film project_orthographic(const OrthographicCamera& camera, const Vec3d& p) {
    return Vec2<double>{(p.x / static_cast<double>(camera.half_width_m) + 1) / 2,
                        (1 - p.y / static_cast<double>(camera.half_height_m)) / 2};
}

Film project_fisheye(const FisheyeCamera& camera, const Vec3d& p) {
    const double theta = std::atan2(std::hypot(p.x, p.y), -p.z);
    if (theta > static_cast<double>(camera.largest_angle)) return std::nullopt;
    return film_from_fisheye(camera, p);
}

/// The rotation to the right, in turns, at which a position is straight ahead of the left eye.
double azimuth_turn(const EnvironmentCamera& camera, const Vec3d& p) {
    const double turn = std::atan2(p.x, -p.z) / (2 * pi_d);
    const double ratio =
        static_cast<double>(camera.half_eyes_m) / std::max(std::hypot(p.x, p.z), 1e-300);
    // The line of sight is tangent to the circle on which the eye moves.
    const double shifted = turn + std::asin(std::min(ratio, 1.0)) / (2 * pi_d) + 0.5;
    return shifted - std::floor(shifted);
}

Film project_round(const EnvironmentCamera& camera, const Vec3d& p) {
    const double eyes = static_cast<double>(camera.half_eyes_m);
    const double horizontal = std::sqrt(std::max(p.x * p.x + p.z * p.z - eyes * eyes, 0.0));
    double v = std::atan2(horizontal, p.y) / pi_d;
    if (camera.projection == EnvironmentProjection::cylindrical) {
        v = (1 - p.y / horizontal / static_cast<double>(camera.half_height)) / 2;
        if (!(v >= 0 && v <= 1)) return std::nullopt;
    }
    return Vec2<double>{azimuth_turn(camera, p), eyes > 0 ? v / 2 : v};
}

Film project_cube(const EnvironmentCamera& camera, const Vec3d& p) {
    const Vec3d size = abs(p);
    const double largest = max_component(size);
    const int axis = size.x == largest ? 0 : size.y == largest ? 1 : 2;
    const double along = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    const int face = 2 * axis + (along < 0 ? 1 : 0);
    // The coordinates to the right and up on each face; see cubemap_ray.
    const double a[6] = {p.z, -p.z, p.x, p.x, -p.x, p.x};
    const double b[6] = {p.y, p.y, p.z, -p.z, p.y, p.y};
    const int column = face % camera.cube_columns;
    const int row = face / camera.cube_columns;
    const int row_count = 6 / camera.cube_columns;
    return Vec2<double>{(column + (a[face] / largest + 1) / 2) / camera.cube_columns,
                        (row + (1 - b[face] / largest) / 2) / row_count};
}

}  // namespace

std::optional<Vec2<double>> project_local(const Camera& camera, const Vec3d& p) {
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            break;
        case CameraModel::orthographic:
            return project_orthographic(camera.orthographic, p);
        case CameraModel::fisheye:
            return project_fisheye(camera.fisheye, p);
        case CameraModel::environment:
            return camera.environment.projection == EnvironmentProjection::cubemap
                       ? project_cube(camera.environment, p)
                       : project_round(camera.environment, p);
    }
    return project_flat(camera, p);
}

std::optional<Vec2<double>> project(const Camera& camera, const Vec3d& position_world) {
    const Affined camera_from_world = inverse(affine_cast<double>(camera.world_from_camera));
    return project_local(camera, transform_point(camera_from_world, position_world));
}

}  // namespace obscura
