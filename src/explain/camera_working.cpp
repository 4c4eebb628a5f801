// explain/camera_working.cpp - the formulas of docs/cameras.md for one pixel, in double precision.
// SPDX-License-Identifier: Apache-2.0
#include "explain/camera_working.h"

#include "camera/names.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// A ray in camera space.
struct OwnRay {
    Vec3d origin = {0, 0, 0};
    Vec3d direction = {0, 0, -1};
};

struct FilmPosition {
    double s, t;  ///< from the left and from the top, in [0, 1]
};

Vec3d unit(const Vec3d& v) {
    return v * (1 / std::hypot(v.x, v.y, v.z));
}

/// OpenCV's lens distortion, y down.
Vec2<double> distorted(const Distortion& d, double x, double y) {
    const double r2 = x * x + y * y;
    const double radial = 1 + d.k1 * r2 + d.k2 * r2 * r2 + d.k3 * r2 * r2 * r2;
    return {x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
            y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y};
}

/// The point that is seen at `wanted`: a secant through three close points, iterated.
///
/// Out  false where there is none within the radius that the model can undo
bool undo_distortion(const Distortion& d, const Vec2<double>& wanted, Vec2<double>& position) {
    const double limit = d.radius_limit;
    const auto pull_in = [&](Vec2<double> p) {
        return p * std::min(1.0, limit / std::max(std::hypot(p.x, p.y), 1e-300));
    };
    position = pull_in(wanted);
    constexpr double step = 1e-7;
    for (int i = 0; i < 60; ++i) {
        const Vec2<double> at = distorted(d, position.x, position.y);
        const Vec2<double> right = (distorted(d, position.x + step, position.y) - at) * (1 / step);
        const Vec2<double> down = (distorted(d, position.x, position.y + step) - at) * (1 / step);
        const Vec2<double> off = wanted - at;
        const double det = right.x * down.y - down.x * right.y;
        if (!(std::abs(det) > 1e-9)) return false;
        position = pull_in(position + Vec2<double>{(down.y * off.x - down.x * off.y) / det,
                                                   (right.x * off.y - right.y * off.x) / det});
    }
    const Vec2<double> at = distorted(d, position.x, position.y);
    return std::hypot(at.x - wanted.x, at.y - wanted.y) < 1e-6 * (1 + std::hypot(at.x, at.y));
}

OwnRay through_plane(const Camera& camera, const FilmPosition& film, CameraWorking& out) {
    const PinholeCamera& pinhole = camera.pinhole;
    const double tall = pinhole.tan_half_yfov;
    const double wide = tall * static_cast<double>(pinhole.aspect);
    Vec2<double> at{(2 * film.s - 1) * wide + static_cast<double>(pinhole.shift_x),
                    (1 - 2 * film.t) * tall + static_cast<double>(pinhole.shift_y)};
    out.terms.emplace_back("tan(fov_x / 2), tan(fov_y / 2)", wide, tall);
    if (pinhole.shift_x != 0.0f || pinhole.shift_y != 0.0f) {
        out.terms.emplace_back("shift", pinhole.shift_x, pinhole.shift_y);
    }
    out.terms.emplace_back(
        "x = (2 s - 1) tan(fov_x / 2), y = (1 - 2 t) tan(fov_y / 2)", at.x, at.y);
    if (is_distorted(camera)) {
        Vec2<double> position{0, 0};
        out.sees = undo_distortion(camera.distortion, {at.x, -at.y}, position);
        at = {position.x, -position.y};
        out.terms.emplace_back("x, y without the lens' distortion", at.x, at.y);
    }
    const double focus = camera.thin_lens.inverse_focus > 0.0f
                             ? 1 / static_cast<double>(camera.thin_lens.inverse_focus)
                             : INFINITY;
    if (camera.model == CameraModel::thin_lens) {
        out.terms.emplace_back("radius of the lens", camera.thin_lens.aperture.radius_m);
        out.terms.emplace_back("sharp at the distance", focus);
    }
    return {{0, 0, 0}, unit({at.x, at.y, -1})};
}

OwnRay parallel(const OrthographicCamera& camera, const FilmPosition& film, CameraWorking& out) {
    const double xmag = camera.half_width_m;
    const double ymag = camera.half_height_m;
    out.terms.emplace_back("xmag, ymag", xmag, ymag);
    return {{(2 * film.s - 1) * xmag, (1 - 2 * film.t) * ymag, 0}, {0, 0, -1}};
}

/// r(theta) of the four-coefficient model.
double opencv_r(const FisheyeCamera& camera, double theta) {
    double r = theta;
    double power = theta;
    for (const float k : camera.k) {
        power *= theta * theta;
        r += static_cast<double>(k) * power;
    }
    return r;
}

/// The angle whose radius is r.
double fisheye_theta(const FisheyeCamera& camera, double r) {
    switch (camera.law) {
        case FisheyeLaw::equidistant:
            return r;
        case FisheyeLaw::equisolid:
            return 2 * std::asin(std::min(r / 2, 1.0));
        case FisheyeLaw::stereographic:
            return 2 * std::atan(r / 2);
        case FisheyeLaw::orthographic:
            return std::asin(std::min(r, 1.0));
        case FisheyeLaw::opencv:
            break;
    }
    double low = 0;
    double high = camera.largest_angle;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (opencv_r(camera, middle) < r ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

const char* fisheye_formula(FisheyeLaw law) {
    switch (law) {
        case FisheyeLaw::equidistant:
            return "theta = r";
        case FisheyeLaw::equisolid:
            return "theta = 2 asin(r / 2)";
        case FisheyeLaw::stereographic:
            return "theta = 2 atan(r / 2)";
        case FisheyeLaw::orthographic:
            return "theta = asin(r)";
        case FisheyeLaw::opencv:
            break;
    }
    return "theta, of r = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)";
}

OwnRay through_fisheye(const FisheyeCamera& camera, const FilmPosition& film, CameraWorking& out) {
    const double half_width = camera.half_width;
    const double half_height = camera.half_height;
    const double x = (2 * film.s - 1) * half_width + static_cast<double>(camera.shift_x);
    const double y = (1 - 2 * film.t) * half_height + static_cast<double>(camera.shift_y);
    const double r = std::hypot(x, y);
    out.sees = r <= static_cast<double>(camera.largest_radius);
    out.terms.emplace_back("radius at the right edge, at the top edge", half_width, half_height);
    out.terms.emplace_back("x, y on the film", x, y);
    out.terms.emplace_back("r = sqrt(x^2 + y^2)", r);
    if (!out.sees) {
        out.terms.emplace_back("the circle ends at r", camera.largest_radius);
        return {};
    }
    const double theta = fisheye_theta(camera, r);
    out.terms.emplace_back(fisheye_formula(camera.law), theta);
    const double across = r > 0 ? std::sin(theta) / r : 1;
    return {{0, 0, 0}, {x * across, y * across, -std::cos(theta)}};
}

OwnRay from_cube(const EnvironmentCamera& camera, const FilmPosition& film, CameraWorking& out) {
    // Forward, right and up of the faces +X, -X, +Y, -Y, +Z, -Z: the table in docs/cameras.md.
    constexpr Vec3d faces[6][3] = {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                   {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                   {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                   {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                                   {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};
    const int columns = camera.cube_columns;
    const int rows = 6 / columns;
    const double column = std::floor(film.s * columns);
    const double row = std::floor(film.t * rows);
    const int face = static_cast<int>(row) * columns + static_cast<int>(column);
    const double a = 2 * (film.s * columns - column) - 1;
    const double b = 1 - 2 * (film.t * rows - row);
    out.terms.emplace_back("face, of +X -X +Y -Y +Z -Z", face + 1);
    out.terms.emplace_back("a to the right and b up on it, in [-1, 1]", a, b);
    const Vec3d(&f)[3] = faces[face];
    return {{0, 0, 0}, unit(f[0] + f[1] * a + f[2] * b)};
}

OwnRay from_environment(const EnvironmentCamera& camera, FilmPosition film, CameraWorking& out) {
    if (camera.projection == EnvironmentProjection::cubemap) return from_cube(camera, film, out);
    double eye = 0;
    if (camera.half_eyes_m != 0.0f) {
        const bool right = film.t >= 0.5;
        eye = right ? static_cast<double>(camera.half_eyes_m)
                    : -static_cast<double>(camera.half_eyes_m);
        film.t = 2 * film.t - (right ? 1 : 0);
        out.terms.emplace_back("the eye is so far to the right", eye);
        out.terms.emplace_back("s, t in its picture", film.s, film.t);
    }
    const double longitude = 2 * pi_d * (film.s - 0.5);
    out.terms.emplace_back("longitude = 2 pi (s - 1/2)", longitude);
    const Vec3d origin{eye * std::cos(longitude), 0, eye * std::sin(longitude)};
    if (camera.projection == EnvironmentProjection::cylindrical) {
        const double height = (1 - 2 * film.t) * static_cast<double>(camera.half_height);
        out.terms.emplace_back("height on the cylinder", height);
        return {origin, unit({std::sin(longitude), height, -std::cos(longitude)})};
    }
    const double polar = pi_d * film.t;
    out.terms.emplace_back("angle from +Y = pi t", polar);
    return {origin,
            {std::sin(polar) * std::sin(longitude),
             std::cos(polar),
             -std::sin(polar) * std::cos(longitude)}};
}

std::string model_text(const Camera& camera) {
    std::string text = name_of(camera_model_names, camera.model);
    if (camera.model == CameraModel::fisheye) {
        text += std::string(", ") + name_of(fisheye_law_names, camera.fisheye.law);
    }
    if (camera.model == CameraModel::environment) {
        text += std::string(", ") +
                name_of(environment_projection_names, camera.environment.projection);
    }
    return text;
}

OwnRay own_ray(const Camera& camera, const FilmPosition& film, CameraWorking& out) {
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            break;
        case CameraModel::orthographic:
            return parallel(camera.orthographic, film, out);
        case CameraModel::fisheye:
            return through_fisheye(camera.fisheye, film, out);
        case CameraModel::environment:
            return from_environment(camera.environment, film, out);
    }
    return through_plane(camera, film, out);
}

/// --near moves the ray's origin, --far ends it.
void clip(const Camera& camera, double axial, CameraWorking& out) {
    const double near = camera.near_m;
    const double far = camera.far_m;
    if (far > 0) out.length_m = (far - near) / axial;
    if (!(near > 0)) return;
    out.terms.emplace_back("it begins so far from the eye (near)", near / axial);
    out.ray.origin = out.ray.origin + out.ray.direction * (near / axial);
}

}  // namespace

CameraWorking work_out_camera(const Camera& camera, const PixelPlace& pixel) {
    CameraWorking out;
    out.model = model_text(camera);
    const FilmPosition film{(pixel.x + 0.5) / pixel.width, (pixel.y + 0.5) / pixel.height};
    out.terms.emplace_back("s = (i + 0.5) / n_x", film.s);
    out.terms.emplace_back("t = (j + 0.5) / n_y", film.t);
    const OwnRay own = own_ray(camera, film, out);
    if (!out.sees) return out;
    out.terms.emplace_back("R_o in the camera's space", own.origin);
    out.terms.emplace_back("R_d in the camera's space", own.direction);
    const Affined world = affine_cast<double>(camera.world_from_camera);
    out.ray = {transform_point(world, own.origin), unit(transform_vector(world, own.direction))};
    clip(camera, measures_from_eye(camera.model) ? 1 : -own.direction.z, out);
    out.terms.emplace_back("R_o in the world", out.ray.origin);
    out.terms.emplace_back("R_d in the world", out.ray.direction);
    return out;
}

}  // namespace obscura
