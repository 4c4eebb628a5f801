// tests/camera/closed_rays.h - the ray of a pixel by each camera's definition, for tests only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <cmath>

namespace obscura::test {

/// A ray in the world; seen is false where the camera shows nothing.
struct ClosedRay {
    Vec3d origin = {0, 0, 0};
    Vec3d direction = {0, 0, -1};
    bool seen = true;
};

struct ClosedPixel {
    int x, y, width, height;
};

namespace closed_rays_detail {

/// Pixel centres on the film, from -1 at the left and the bottom to 1.
struct Share {
    double right, up;
};

inline Share share_of(const ClosedPixel& p) {
    return {(2.0 * p.x + 1 - p.width) / p.width, (p.height - 1 - 2.0 * p.y) / p.height};
}

/// Looks at a point of the plane one metre ahead. Distortion is undone as OpenCV's undistortPoints
/// does: the added distortion is subtracted until nothing changes.
inline ClosedRay flat(const Camera& camera, const Share& at) {
    const double tall = camera.pinhole.tan_half_yfov;
    double x = at.right * tall * static_cast<double>(camera.pinhole.aspect);
    double y = at.up * tall;
    x += static_cast<double>(camera.pinhole.shift_x);
    y += static_cast<double>(camera.pinhole.shift_y);
    ClosedRay ray;
    const Distortion& d = camera.distortion;
    if (d.radius_limit > 0.0f) {
        const double wanted_x = x;
        const double wanted_y = -y;
        double px = wanted_x;
        double py = wanted_y;
        for (int i = 0; i < 500; ++i) {
            const double r2 = px * px + py * py;
            const double radial = 1 + ((d.k3 * r2 + d.k2) * r2 + d.k1) * r2;
            const double dx = 2 * d.p1 * px * py + d.p2 * (r2 + 2 * px * px);
            const double dy = d.p1 * (r2 + 2 * py * py) + 2 * d.p2 * px * py;
            px = (wanted_x - dx) / radial;
            py = (wanted_y - dy) / radial;
        }
        ray.seen = std::hypot(px, py) <= static_cast<double>(d.radius_limit);
        x = px;
        y = -py;
    }
    const double length = std::hypot(x, y, 1.0);
    ray.direction = {x / length, y / length, -1 / length};
    return ray;
}

/// The angle from the axis whose radius on the film is r.
inline double angle_of(const FisheyeCamera& camera, double r) {
    switch (camera.law) {
        case FisheyeLaw::equidistant:
            return r;
        case FisheyeLaw::equisolid:
            return 2 * std::asin(r / 2);
        case FisheyeLaw::stereographic:
            return 2 * std::atan2(r, 2);
        case FisheyeLaw::orthographic:
            return std::atan2(r, std::sqrt(1 - r * r));
        case FisheyeLaw::opencv:
            break;
    }
    double theta = r;
    for (int i = 0; i < 500; ++i) {
        const double s = theta * theta;
        double scale = 0;
        for (int k = 3; k >= 0; --k)
            scale = (scale + static_cast<double>(camera.k[k])) * s;
        theta = 0.5 * (theta + r / (1 + scale));
    }
    return theta;
}

inline ClosedRay fisheye(const FisheyeCamera& camera, const Share& at) {
    const double x = at.right * static_cast<double>(camera.half_width);
    const double y = at.up * static_cast<double>(camera.half_height);
    const double r = std::hypot(x, y);
    ClosedRay ray;
    ray.seen = r <= static_cast<double>(camera.largest_radius);
    if (!ray.seen) return ray;
    const double theta = angle_of(camera, r);
    const double turn = std::atan2(y, x);
    ray.direction = {
        std::sin(theta) * std::cos(turn), std::sin(theta) * std::sin(turn), -std::cos(theta)};
    return ray;
}

/// A face of the cube map as a rotated camera: about the vertical, or up and down.
inline ClosedRay cube_face(const EnvironmentCamera& camera, const ClosedPixel& p) {
    const int columns = camera.cube_columns;
    const int rows = 6 / columns;
    // In faces from the left and from the top; an image's side need not be a multiple of them.
    const double across = (p.x + 0.5) * columns / p.width;
    const double down = (p.y + 0.5) * rows / p.height;
    const int face = static_cast<int>(down) * columns + static_cast<int>(across);
    const double a = 2 * std::fmod(across, 1.0) - 1;
    const double b = 1 - 2 * std::fmod(down, 1.0);
    const Vec3d faces[6] = {{1, b, a}, {-1, b, -a}, {a, 1, b}, {a, -1, -b}, {-a, b, 1}, {a, b, -1}};
    const double length = std::hypot(a, b, 1.0);
    return {{0, 0, 0}, faces[face] * (1 / length), true};
}

inline ClosedRay environment(const EnvironmentCamera& camera, ClosedPixel p) {
    if (camera.projection == EnvironmentProjection::cubemap) return cube_face(camera, p);
    double eye = 0;
    if (camera.half_eyes_m > 0.0f) {
        p.height /= 2;
        eye = p.y < p.height ? -static_cast<double>(camera.half_eyes_m)
                             : static_cast<double>(camera.half_eyes_m);
        p.y %= p.height;
    }
    const Share at = share_of(p);
    const double longitude = pi_d * at.right;  // to the right of -Z
    const Vec3d ahead{std::sin(longitude), 0, -std::cos(longitude)};
    const Vec3d right{std::cos(longitude), 0, std::sin(longitude)};
    const bool cylinder = camera.projection == EnvironmentProjection::cylindrical;
    const double latitude =
        cylinder ? std::atan(at.up * static_cast<double>(camera.half_height)) : 0.5 * pi_d * at.up;
    return {right * eye, ahead * std::cos(latitude) + Vec3d{0, std::sin(latitude), 0}, true};
}

}  // namespace closed_rays_detail

/// The ray through the centres of a pixel and of the lens, without clipping, by the definitions in
/// docs/cameras.md; it shares only the numbers in Camera with the program.
inline ClosedRay closed_ray(const Camera& camera, const ClosedPixel& pixel) {
    using namespace closed_rays_detail;
    ClosedRay ray;
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            ray = flat(camera, share_of(pixel));
            break;
        case CameraModel::orthographic: {
            const Share at = share_of(pixel);
            ray.origin = {at.right * static_cast<double>(camera.orthographic.half_width_m),
                          at.up * static_cast<double>(camera.orthographic.half_height_m),
                          0};
            break;
        }
        case CameraModel::fisheye:
            ray = fisheye(camera.fisheye, share_of(pixel));
            break;
        case CameraModel::environment:
            ray = environment(camera.environment, pixel);
            break;
    }
    const auto turn = [&](const Vec3d& v) {
        const auto& m = camera.world_from_camera.m;
        Vec3d out{0, 0, 0};
        out = out + Vec3d{m[0][0], m[1][0], m[2][0]} * v.x;
        out = out + Vec3d{m[0][1], m[1][1], m[2][1]} * v.y;
        return out + Vec3d{m[0][2], m[1][2], m[2][2]} * v.z;
    };
    const auto& m = camera.world_from_camera.m;
    ray.origin = turn(ray.origin) + Vec3d{m[0][3], m[1][3], m[2][3]};
    const Vec3d direction = turn(ray.direction);
    ray.direction = direction * (1 / std::hypot(direction.x, direction.y, direction.z));
    return ray;
}

}  // namespace obscura::test
