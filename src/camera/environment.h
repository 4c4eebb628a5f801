// camera/environment.h - panoramic cameras: latitude-longitude, cylinder, cube map; mono or stereo.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera_ray.h"
#include "math/warp.h"

namespace obscura {

/// To add one: append it here, give it a function and a case in generate_ray below, its inverse in
/// camera/project.cpp, a name in camera/names.h, its sizes in session/camera_build.cpp, its terms
/// in explain/camera_working.cpp, its closed form in tests/camera, and a line in docs/cameras.md
/// and in the schema of docs/extensions/OBSCURA_camera.
enum class EnvironmentProjection : int { latlong, cylindrical, cubemap };

/// The centre of a latitude-longitude or cylindrical image looks down -Z, +X is right of it.
struct EnvironmentCamera {
    EnvironmentProjection projection = EnvironmentProjection::latlong;
    float half_height = 1;   ///< cylinder: tangent of half its vertical angle
    float half_eyes_m = 0;   ///< half the distance between the eyes; 0: one eye
    int cube_columns = 6;    ///< faces side by side: 6, 3 or 1
    float pixel_width = 0;   ///< angle of a pixel along the horizon, radians; cube: on the face
    float pixel_height = 0;  ///< angle of a pixel at the horizon, upwards
};

inline namespace OBSCURA_ISA {

/// Sine and cosine of t turns to the last bit or two, because panoramas are large.
///
/// In      t: in [-1, 2]
template <typename F>
OBSCURA_INLINE SinCos<F> precise_turn(const F& t) {
    if constexpr (std::is_same_v<F, double>) {
        return {sin(2.0 * pi_d * t), cos(2.0 * pi_d * t)};
    } else {
        const F quadrant = floor(F(4.0f) * t + F(0.5f));
        const F x = (F(4.0f) * t - quadrant) * F(0.5f * pi_f);
        return turned_by_quarters(sin_cos(x), quadrant);
    }
}

/// The eye of a pixel, and its position in that eye's image: the left eye has the upper half.
template <typename F>
struct EyeView {
    Vec2<F> film;
    F offset_m;  ///< of the eye, to the right
};

template <typename F>
OBSCURA_INLINE EyeView<F> eye_view(const EnvironmentCamera& camera, const FilmPoint<F>& point) {
    if (camera.half_eyes_m == 0.0f) return {point.film, F(0.0f)};
    const auto right = point.pixel_centre.y >= F(0.5f);
    const F top = select(right, F(1.0f), F(0.0f));
    const F eyes = F(camera.half_eyes_m);
    return {{point.film.x, F(2.0f) * point.film.y - top}, select(right, eyes, -eyes)};
}

/// Position of the eye for a view direction rotated to the right by `turn`.
///
/// Source  Ishiguro, Yamamoto, Tsuji, "Omni-Directional Stereo", PAMI 14(2), 1992
template <typename F>
OBSCURA_INLINE Vec3<F> eye_origin(const SinCos<F>& turn, const F& offset_m) {
    return {turn.cos * offset_m, F(0.0f), turn.sin * offset_m};
}

/// Longitude grows to the right, latitude upwards.
template <typename F>
OBSCURA_INLINE CameraRay<F> latlong_ray(const EnvironmentCamera& camera,
                                        const FilmPoint<F>& point) {
    const EyeView<F> eye = eye_view(camera, point);
    const SinCos<F> azimuth = precise_turn(eye.film.x - F(0.5f));
    const SinCos<F> polar = precise_turn(F(0.5f) * eye.film.y);
    const Vec3<F> direction{polar.sin * azimuth.sin, polar.cos, -(polar.sin * azimuth.cos)};
    const F spread = max(F(camera.pixel_height), F(camera.pixel_width) * abs(polar.sin));
    return {eye_origin(azimuth, eye.offset_m), normalize(direction), F(0.0f), spread, always<F>()};
}

/// The image is on a cylinder around +Y.
template <typename F>
OBSCURA_INLINE CameraRay<F> cylindrical_ray(const EnvironmentCamera& camera,
                                            const FilmPoint<F>& point) {
    const EyeView<F> eye = eye_view(camera, point);
    const SinCos<F> azimuth = precise_turn(eye.film.x - F(0.5f));
    const F height = (F(1.0f) - F(2.0f) * eye.film.y) * F(camera.half_height);
    const Vec3<F> direction{azimuth.sin, height, -azimuth.cos};
    const F nearness = F(1.0f) / sqrt(F(1.0f) + height * height);
    const F spread = max(F(camera.pixel_height) * nearness, F(camera.pixel_width)) * nearness;
    return {eye_origin(azimuth, eye.offset_m), normalize(direction), F(0.0f), spread, always<F>()};
}

/// One of six numbers for each lane.
template <typename F>
OBSCURA_INLINE F of_face(const F& face, const float (&values)[6]) {
    F out = F(values[0]);
    for (int i = 1; i < 6; ++i)
        out = select(face == F(static_cast<float>(i)), F(values[i]), out);
    return out;
}

/// Six square images of 90 degrees, row by row: right, left, up, down, back, front (+X, -X, +Y, -Y,
/// +Z, -Z), each as seen from the centre. The upper edge of `up` continues `back`.
template <typename F>
OBSCURA_INLINE CameraRay<F> cubemap_ray(const EnvironmentCamera& camera,
                                        const FilmPoint<F>& point) {
    const F columns = F(static_cast<float>(camera.cube_columns));
    const int row_count = 6 / camera.cube_columns;
    const F rows = F(static_cast<float>(row_count));
    const F column = floor(point.pixel_centre.x * columns);
    const F row = floor(point.pixel_centre.y * rows);
    const F face = row * columns + column;
    const F a = F(2.0f) * (point.film.x * columns - column) - F(1.0f);
    const F b = F(1.0f) - F(2.0f) * (point.film.y * rows - row);
    //                         +X  -X  +Y  -Y  +Z  -Z
    const Vec3<F> direction{
        of_face(face, {1, -1, 0, 0, 0, 0}) + a * of_face(face, {0, 0, 1, 1, -1, 1}),
        of_face(face, {0, 0, 1, -1, 0, 0}) + b * of_face(face, {1, 1, 0, 0, 1, 1}),
        of_face(face, {0, 0, 0, 0, 1, -1}) + a * of_face(face, {1, -1, 0, 0, 0, 0}) +
            b * of_face(face, {0, 0, 1, -1, 0, 0})};
    return {splat3(F(0.0f)), normalize(direction), F(0.0f), F(camera.pixel_height), always<F>()};
}

/// The ray in camera space. Unlike with most models, it may point backwards.
template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const EnvironmentCamera& camera,
                                         const FilmPoint<F>& point) {
    switch (camera.projection) {
        case EnvironmentProjection::latlong:
            break;
        case EnvironmentProjection::cylindrical:
            return cylindrical_ray(camera, point);
        case EnvironmentProjection::cubemap:
            return cubemap_ray(camera, point);
    }
    return latlong_ray(camera, point);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
