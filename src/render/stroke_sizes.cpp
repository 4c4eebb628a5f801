// render/stroke_sizes.cpp - points and lines as thick as asked for, in metres or in pixels.
// SPDX-License-Identifier: Apache-2.0
#include "render/stroke_sizes.h"

#include "scene/split_curves.h"
#include "scene/stroke_radii.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

Vec3d column(const Affinef& map, int c) {
    return {map.m[0][c], map.m[1][c], map.m[2][c]};
}

/// Metres along the view axis.
double depth_m(const Camera& camera, const Vec3d& place_m) {
    const Vec3d eye = column(camera.world_from_camera, 3);
    return -dot(place_m - eye, column(camera.world_from_camera, 2));
}

bool narrows_to_a_plane(const Camera& camera) {
    return camera.model == CameraModel::pinhole || camera.model == CameraModel::thin_lens;
}

RadiusAt radius_of(const StrokeSize& size, const Camera& camera) {
    const double half = 0.5 * size.diameter;
    if (size.unit == LengthUnit::metres) {
        return [half](const Vec3d&) { return half; };
    }
    return [half, &camera](const Vec3d& place_m) { return half * pixel_size_m(camera, place_m); };
}

}  // namespace

bool has_strokes(const Scene& scene) {
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), is_point_or_line);
}

double pixel_size_m(const Camera& camera, const Vec3d& place_m) {
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            return std::abs(depth_m(camera, place_m)) *
                   static_cast<double>(camera.pinhole.pixel_spread);
        case CameraModel::orthographic:
            return static_cast<double>(camera.orthographic.pixel_width_m);
        case CameraModel::fisheye:
        case CameraModel::environment:
            break;
    }
    const CameraRay<float> middle = generate_ray(camera, Vec2f{0.5f, 0.5f});
    const Vec3d eye = column(camera.world_from_camera, 3);
    return length(place_m - eye) * static_cast<double>(middle.cone_spread);
}

void size_strokes(const StrokeSizes& sizes, const Camera& camera, Scene& scene) {
    if (sizes.lines.unit == LengthUnit::pixels && narrows_to_a_plane(camera)) {
        split_curves(scene, [&](const Vec3d& place_m) { return depth_m(camera, place_m); });
    }
    set_stroke_radii(scene, radius_of(sizes.points, camera), radius_of(sizes.lines, camera));
}

}  // namespace obscura
