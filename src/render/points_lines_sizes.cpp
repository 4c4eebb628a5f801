// render/points_lines_sizes.cpp - sets the thickness of points and lines, in metres or in pixels.
// SPDX-License-Identifier: Apache-2.0
#include "render/points_lines_sizes.h"

#include "scene/points_lines_radii.h"
#include "scene/split_curves.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

Vec3d column(const Affinef& map, int c) {
    return {map.m[0][c], map.m[1][c], map.m[2][c]};
}

/// Metres along the view axis.
double depth_m(const Camera& camera, const Vec3d& position_m) {
    const Vec3d eye = column(camera.world_from_camera, 3);
    return -dot(position_m - eye, column(camera.world_from_camera, 2));
}

bool narrows_to_a_plane(const Camera& camera) {
    return camera.model == CameraModel::pinhole || camera.model == CameraModel::thin_lens;
}

RadiusAt radius_of(const PointsLinesSize& size, const Camera& camera) {
    const double half = 0.5 * size.diameter;
    if (size.unit == LengthUnit::metres) {
        return [half](const Vec3d&) { return half; };
    }
    return [half, &camera](const Vec3d& position_m) {
        return half * pixel_size_m(camera, position_m);
    };
}

}  // namespace

bool has_points_lines(const Scene& scene) {
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), is_point_or_line);
}

double pixel_size_m(const Camera& camera, const Vec3d& position_m) {
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            return std::abs(depth_m(camera, position_m)) *
                   static_cast<double>(camera.pinhole.pixel_spread);
        case CameraModel::orthographic:
            return static_cast<double>(camera.orthographic.pixel_width_m);
        case CameraModel::fisheye:
        case CameraModel::environment:
            break;
    }
    const CameraRay<float> centre = generate_ray(camera, Vec2f{0.5f, 0.5f});
    const Vec3d eye = column(camera.world_from_camera, 3);
    return length(position_m - eye) * static_cast<double>(centre.cone_spread);
}

void size_points_lines(const PointsLinesSizes& sizes, const Camera& camera, Scene& scene) {
    if (sizes.lines.unit == LengthUnit::pixels && narrows_to_a_plane(camera)) {
        split_curves(scene, [&](const Vec3d& position_m) { return depth_m(camera, position_m); });
    }
    set_points_lines_radii(scene, radius_of(sizes.points, camera), radius_of(sizes.lines, camera));
}

}  // namespace obscura
