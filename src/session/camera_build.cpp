// session/camera_build.cpp - makes a camera from its position, angle and settings.
// SPDX-License-Identifier: Apache-2.0
#include "session/camera_build.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "camera/exposure.h"
#include "camera/lens_equation.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// Height of 35 mm film, for the focal length of a camera that has only an angle.
constexpr double usual_sensor_height_m = 0.024;
/// Tangent up to which distortion is followed: 89.4 degrees.
constexpr double widest_distorted = 100;

float narrow(double value) {
    return static_cast<float>(value);
}

tl::unexpected<Error> refuse(const char* id, const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, id, where, message);
}

/// A film at distance 1 before the eye, or before the lens' centre.
struct FilmPlane {
    double tan_half_xfov, tan_half_yfov;
    double shift_x, shift_y;
};

/// Intrinsics of another image size hold for this one, scaled.
FilmPlane film_from_intrinsics(const Intrinsics& i) {
    return {i.width_px / (2 * i.fx_px),
            i.height_px / (2 * i.fy_px),
            (i.width_px / 2 - i.cx_px) / i.fx_px,
            (i.cy_px - i.height_px / 2) / i.fy_px};
}

/// Distance of the film behind the lens: with an f-number, that of a real lens in focus.
double film_distance(const CameraSettings& s, bool is_lens, double focus_m) {
    const bool real = is_lens && s.fstop && focus_m > *s.focal_length_m;
    return real ? image_distance(*s.focal_length_m, focus_m) : *s.focal_length_m;
}

FilmPlane flat_film(const CameraBasis& basis,
                    const CameraSettings& s,
                    ImageSize size,
                    double film_distance_m) {
    if (s.intrinsics) return film_from_intrinsics(*s.intrinsics);
    const double aspect = static_cast<double>(size.width_px) / size.height_px;
    double half_height = basis.tan_half_yfov;
    if (s.focal_length_m && s.sensor_m && !basis.keeps_angle) {
        // The whole sensor is visible, as the view of a file's camera always is.
        const double wide = (*s.sensor_m)[0] / (2 * film_distance_m);
        half_height = std::max((*s.sensor_m)[1] / (2 * film_distance_m), wide / aspect);
    }
    const std::array<double, 2> shift = s.shift.value_or(std::array<double, 2>{0, 0});
    return {half_height * aspect,
            half_height,
            2 * shift[0] * half_height * aspect,
            2 * shift[1] * half_height};
}

void set_film(const FilmPlane& film, ImageSize size, PinholeCamera& out) {
    out.tan_half_yfov = narrow(film.tan_half_yfov);
    out.aspect = narrow(film.tan_half_xfov / film.tan_half_yfov);
    out.pixel_spread = narrow(2 * film.tan_half_yfov / size.height_px);
    out.shift_x = narrow(film.shift_x);
    out.shift_y = narrow(film.shift_y);
}

Distortion make_distortion(const std::array<double, 5>& k) {
    if (std::all_of(k.begin(), k.end(), [](double c) { return c == 0; })) return {};
    return {narrow(k[0]),
            narrow(k[1]),
            narrow(k[2]),
            narrow(k[3]),
            narrow(k[4]),
            narrow(largest_radius(k[0], k[1], k[4], widest_distorted) * (1 - 1e-6))};
}

/// The lens' opening and focus.
Result<ThinLens> make_lens(const CameraSettings& s, double focus_m, double tan_half_yfov) {
    ThinLens lens;
    lens.inverse_focus = narrow(1 / focus_m);
    lens.aperture.blades = s.blades.value_or(0);
    lens.aperture.squeeze = narrow(1 / s.anamorphic.value_or(1));
    const double turns = s.blade_rotation_rad.value_or(0) / (2 * pi_d);
    lens.aperture.rotation_turns = narrow(turns - std::floor(turns));
    if (s.lens_radius_m) {
        lens.aperture.radius_m = narrow(*s.lens_radius_m);
        return lens;
    }
    if (!s.fstop) {
        return refuse("E-CAM-LENS",
                      setting("camera-model"),
                      "a thin lens needs an opening: give " + setting("fstop") + " N or " +
                          setting("lens-radius") + " METRES");
    }
    const double height = s.sensor_m ? (*s.sensor_m)[1] : usual_sensor_height_m;
    const double film = height / (2 * tan_half_yfov);
    const double focal = s.focal_length_m.value_or(1 / (1 / film + 1 / focus_m));
    if (!(focus_m > focal)) {
        return refuse("E-CAM-LENS",
                      setting("focus-distance"),
                      "a lens of focal length " + shortest(focal) + " m makes nothing sharp at " +
                          shortest(focus_m) + " m; expected a larger distance");
    }
    lens.aperture.radius_m = narrow(focal / (2 * *s.fstop));
    return lens;
}

Result<void> set_flat(const CameraBasis& basis,
                      const CameraSettings& s,
                      ImageSize size,
                      Camera& out) {
    const bool is_lens = out.model == CameraModel::thin_lens;
    const double focus = s.focus_distance_m.value_or(basis.focus_m);
    if (s.focal_length_m && !is_lens && !s.sensor_m && !basis.keeps_angle) {
        return refuse("E-CAM-LENS",
                      setting("focal-length"),
                      "a focal length gives an angle only together with the film's size; add " +
                          setting("sensor") + ", its width and height");
    }
    const double distance = s.focal_length_m ? film_distance(s, is_lens, focus) : 0;
    const FilmPlane film = flat_film(basis, s, size, distance);
    set_film(film, size, out.pinhole);
    if (s.distortion) out.distortion = make_distortion(*s.distortion);
    if (!is_lens) return {};
    const Result<ThinLens> lens = make_lens(s, focus, film.tan_half_yfov);
    if (!lens) return fail(lens.error());
    out.thin_lens = *lens;
    return {};
}

void set_orthographic(const CameraBasis& basis,
                      const CameraSettings& s,
                      ImageSize size,
                      OrthographicCamera& out) {
    const double aspect = static_cast<double>(size.width_px) / size.height_px;
    double half_height = basis.half_height_m;
    if (s.magnification_m) {
        half_height = std::max((*s.magnification_m)[1], (*s.magnification_m)[0] / aspect);
    }
    out.half_width_m = narrow(half_height * aspect);
    out.half_height_m = narrow(half_height);
    out.pixel_width_m = narrow(2 * half_height / size.height_px);
}

Result<void> set_fisheye(const CameraSettings& s, ImageSize size, FisheyeCamera& out) {
    const bool has_k = s.fisheye_k.has_value();
    out.law = s.fisheye.value_or(has_k ? FisheyeLaw::opencv : FisheyeLaw::equidistant);
    const std::array<double, 4> k = s.fisheye_k.value_or(std::array<double, 4>{0, 0, 0, 0});
    std::transform(k.begin(), k.end(), out.k, narrow);
    const double widest = largest_fisheye_angle(out.law, k.data());
    const double usual = s.intrinsics ? pi_d : std::min(widest, pi_d / 2);
    double angle = s.fisheye_fov_rad ? 0.5 * *s.fisheye_fov_rad : std::min(usual, widest);
    if (angle > widest * (1 + 1e-9)) {
        return refuse("E-CAM-FISHEYE",
                      setting("fov"),
                      "this fisheye shows at most " +
                          shortest(std::floor(3600 * widest / pi_d) / 10) +
                          " degrees; a wider view needs another law, such as equidistant");
    }
    angle = std::min(angle, widest);
    out.largest_angle = narrow(angle);
    out.largest_radius = fisheye_radius(out, out.largest_angle);
    const double radius = fisheye_radius(out, angle);
    if (s.intrinsics) {
        const FilmPlane film = film_from_intrinsics(*s.intrinsics);
        out.half_width = narrow(film.tan_half_xfov);
        out.half_height = narrow(film.tan_half_yfov);
        out.shift_x = narrow(film.shift_x);
        out.shift_y = narrow(film.shift_y);
    } else {
        const double w = size.width_px;
        const double h = size.height_px;
        const bool covers = s.fisheye_fit.value_or(FisheyeFit::circle) == FisheyeFit::diagonal;
        const double focal_px = (covers ? std::hypot(w, h) : std::min(w, h)) / (2 * radius);
        const std::array<double, 2> shift = s.shift.value_or(std::array<double, 2>{0, 0});
        out.half_width = narrow(w / (2 * focal_px));
        out.half_height = narrow(h / (2 * focal_px));
        out.shift_x = narrow(shift[0] * w / focal_px);
        out.shift_y = narrow(shift[1] * h / focal_px);
    }
    out.pixel_spread = 2 * out.half_height / static_cast<float>(size.height_px);
    return {};
}

/// Faces side by side; 0 when squares do not fill the image.
int cube_columns(ImageSize size) {
    for (const int columns : {6, 3, 1}) {
        const int64_t rows = 6 / columns;
        if (size.width_px * rows == static_cast<int64_t>(size.height_px) * columns) return columns;
    }
    return 0;
}

Result<void> set_environment(const CameraSettings& s, ImageSize size, EnvironmentCamera& out) {
    out.projection = s.environment.value_or(EnvironmentProjection::latlong);
    out.half_eyes_m = narrow(0.5 * s.stereo_m.value_or(0));
    const double eye_height = s.stereo_m.value_or(0) > 0 ? size.height_px / 2.0 : size.height_px;
    const auto refuse_size = [&](const std::string& message) {
        return refuse("E-CAM-SIZE", setting("size"), message);
    };
    out.pixel_width = narrow(2 * pi_d / size.width_px);
    if (out.projection == EnvironmentProjection::cubemap) {
        out.cube_columns = cube_columns(size);
        if (out.half_eyes_m > 0)
            return refuse("E-CAM-SIZE", setting("stereo"), "a cube map has one eye");
        if (out.cube_columns == 0) {
            return refuse_size(
                "six square faces do not fill this picture; expected WxH with W:H "
                "as 6:1, 3:2 or 1:6, such as 1536x256");
        }
        out.pixel_height = narrow(2.0 * out.cube_columns / size.width_px);
        return {};
    }
    if (out.half_eyes_m > 0 && size.height_px % 2 != 0) {
        return refuse_size("two eyes need an even height: the left one has the upper half");
    }
    if (out.projection == EnvironmentProjection::latlong) {
        out.pixel_height = narrow(pi_d / eye_height);
        return {};
    }
    // Without an angle, pixels are square.
    const double square = pi_d * eye_height / size.width_px;
    const double half_height = s.cylinder_fov_rad ? std::tan(0.5 * *s.cylinder_fov_rad) : square;
    out.half_height = narrow(half_height);
    out.pixel_height = narrow(2 * half_height / eye_height);
    return {};
}

/// Unless it is aimed explicitly, an image of all directions is oriented like an environment map:
/// its centre at +X (a cube's faces are those of the world's axes).
Affined environment_place(const Affined& place, const CameraSettings& s) {
    if (s.align.value_or(EnvironmentAlign::world) == EnvironmentAlign::view) return place;
    const bool cube = s.environment == EnvironmentProjection::cubemap;
    Affined out;
    if (!cube) out = {{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}}};
    for (int r = 0; r < 3; ++r)
        out.m[r][3] = place.m[r][3];
    return out;
}

}  // namespace

Affined camera_place(const Affined& world_from_camera,
                     CameraModel model,
                     const CameraSettings& settings) {
    if (model != CameraModel::environment) return world_from_camera;
    return environment_place(world_from_camera, settings);
}

Result<Camera> make_camera(const CameraBasis& basis,
                           CameraModel model,
                           const CameraSettings& settings,
                           ImageSize size) {
    Camera out;
    out.model = model;
    out.world_from_camera =
        affine_cast<float>(camera_place(basis.world_from_camera, model, settings));
    out.near_m = narrow(settings.near_m.value_or(0));
    out.far_m = narrow(settings.far_m.value_or(0));
    if (out.far_m > 0 && !(out.far_m > out.near_m)) {
        return refuse("E-CAM-CLIP", setting("far"), "it must be larger than the near distance");
    }
    Result<void> done;
    switch (model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            done = set_flat(basis, settings, size, out);
            break;
        case CameraModel::orthographic:
            set_orthographic(basis, settings, size, out.orthographic);
            break;
        case CameraModel::fisheye:
            done = set_fisheye(settings, size, out.fisheye);
            break;
        case CameraModel::environment:
            done = set_environment(settings, size, out.environment);
            break;
    }
    if (!done) return fail(done.error());
    return out;
}

Result<std::optional<double>> chosen_exposure(const CameraSettings& s) {
    if (s.ev100) return s.ev100;
    if (!s.shutter_s && !s.iso) return std::optional<double>();
    if (!s.shutter_s || !s.fstop) {
        return refuse("E-CAM-EXPOSURE",
                      setting(s.shutter_s ? "fstop" : "exposure-time"),
                      "an exposure needs " + setting("fstop") + " and " + setting("exposure-time") +
                          " (and " + setting("iso") + ", else 100), or " + setting("ev100"));
    }
    return std::optional<double>(exposure_value(*s.fstop, *s.shutter_s, s.iso.value_or(100)));
}

}  // namespace obscura
