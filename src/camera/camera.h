// camera/camera.h - the closed list of camera models, in one plain record that stages read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/distortion.h"
#include "camera/environment.h"
#include "camera/fisheye.h"
#include "camera/orthographic.h"
#include "camera/pinhole.h"
#include "camera/thin_lens.h"

namespace obscura {

/// To add a model: write camera/<model>.h with its parameters, `generate_ray`, its inverse and the
/// source of the formula; append a name here, in camera/names.h and in include/obscura/view.h, a
/// member to Camera, a case to local_ray and visit_model below, to project_local in
/// camera/project.cpp, to camera_matrices in camera/matrices.cpp and to make_camera in
/// session/camera_build.cpp. The compiler names the other switches: session/camera_choice.cpp,
/// session/camera_parameters.cpp, render/points_lines_sizes.cpp, explain/camera_working.cpp. What
/// no switch asks: measures_from_eye and limits_rays below, and max_fov_deg in
/// session/model_settings.h. Settings go into scene/camera_settings.h, by its recipe. Then a test
/// against the closed form in tests/camera, a section in docs/cameras.md, docs/cli.md by `obscura
/// print-docs`, and the name in README.md and schema.json of docs/extensions/OBSCURA_camera.
enum class CameraModel : int { pinhole = 0, orthographic, thin_lens, fisheye, environment };

/// A camera in the world. Only the member that `model` names is used, except that thin lenses also
/// use `pinhole`, for the film.
struct Camera {
    CameraModel model = CameraModel::pinhole;
    Affinef world_from_camera;  ///< rigid: rotation and translation; looks down -Z, +Y up
    float near_m = 0;           ///< nothing nearer is seen; 0: everything is
    float far_m = 0;            ///< nothing further is seen; 0: everything is
    PinholeCamera pinhole;
    Distortion distortion;  ///< of a pinhole's or thin lens' image
    OrthographicCamera orthographic;
    ThinLens thin_lens;
    FisheyeCamera fisheye;
    EnvironmentCamera environment;
};

/// True when near and far are distances from the eye; else they are planes across the view.
OBSCURA_INLINE constexpr bool measures_from_eye(CameraModel model) {
    return model == CameraModel::fisheye || model == CameraModel::environment;
}

OBSCURA_INLINE bool is_distorted(const Camera& camera) {
    const bool flat =
        camera.model == CameraModel::pinhole || camera.model == CameraModel::thin_lens;
    return flat && camera.distortion.radius_limit > 0.0f;
}

/// True when some rays end before infinity, or some film points lie outside the camera's image.
OBSCURA_INLINE bool limits_rays(const Camera& camera) {
    return camera.far_m > 0.0f || camera.model == CameraModel::fisheye || is_distorted(camera);
}

inline namespace OBSCURA_ISA {

/// Selects the code that makes rays: a camera model, with or without distortion.
template <CameraModel model_value, bool distorted_value = false>
struct RayMaker {
    static constexpr CameraModel model = model_value;
    static constexpr bool distorted = distorted_value;
    static constexpr bool has_lens = model == CameraModel::thin_lens;
};

/// Calls use(RayMaker) once, so that a loop over film points is compiled for each model. A lens of
/// radius 0 equals a pinhole bit by bit, as does any lens if all rays pass its centre.
template <typename Use>
OBSCURA_INLINE void visit_model(const Camera& camera, bool whole_lens, Use use) {
    const bool distorted = is_distorted(camera);
    switch (camera.model) {
        case CameraModel::pinhole:
            break;
        case CameraModel::orthographic:
            return use(RayMaker<CameraModel::orthographic>());
        case CameraModel::thin_lens:
            if (!whole_lens || !(camera.thin_lens.aperture.radius_m > 0.0f)) break;
            if (distorted) return use(RayMaker<CameraModel::thin_lens, true>());
            return use(RayMaker<CameraModel::thin_lens>());
        case CameraModel::fisheye:
            return use(RayMaker<CameraModel::fisheye>());
        case CameraModel::environment:
            return use(RayMaker<CameraModel::environment>());
    }
    if (distorted) return use(RayMaker<CameraModel::pinhole, true>());
    return use(RayMaker<CameraModel::pinhole>());
}

/// The ray of a pinhole or thin lens in camera space.
template <typename Maker, typename F>
OBSCURA_INLINE CameraRay<F> flat_ray(const Camera& camera, const FilmPoint<F>& point) {
    Vec2<F> plane = plane_from_film(camera.pinhole, point.film);
    MaskOf<F> valid = always<F>();
    if constexpr (Maker::distorted) {
        const Undistorted<F> inner = undistort(camera.distortion, Vec2<F>{plane.x, -plane.y});
        plane = {inner.position.x, -inner.position.y};
        valid = inner.valid;
    }
    CameraRay<F> ray;
    if constexpr (Maker::has_lens) {
        ray = lens_ray(camera.pinhole, camera.thin_lens, plane, point.lens);
    } else {
        ray = ray_through(camera.pinhole, plane);
    }
    ray.valid = valid;
    return ray;
}

/// The ray in camera space.
template <typename Maker, typename F>
OBSCURA_INLINE CameraRay<F> local_ray(const Camera& camera, const FilmPoint<F>& point) {
    if constexpr (Maker::model == CameraModel::orthographic) {
        return generate_ray(camera.orthographic, point);
    } else if constexpr (Maker::model == CameraModel::fisheye) {
        return generate_ray(camera.fisheye, point);
    } else if constexpr (Maker::model == CameraModel::environment) {
        return generate_ray(camera.environment, point);
    } else {
        return flat_ray<Maker>(camera, point);
    }
}

/// A ray in the world.
template <typename F>
struct WorldRay {
    CameraRay<F> ray;
    F axial;  ///< cosine between the ray and the axis along which near and far are measured
};

/// Makes the world-space ray for one film point. With a near distance it begins there.
///
/// Out     unit direction; footprint of one pixel for texture filtering
template <typename Maker, typename F>
OBSCURA_INLINE WorldRay<F> world_ray(const Camera& camera, const FilmPoint<F>& point) {
    constexpr bool round = measures_from_eye(Maker::model);
    const CameraRay<F> local = local_ray<Maker>(camera, point);
    Affine<F> world_from_camera;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            world_from_camera.m[r][c] = F(camera.world_from_camera.m[r][c]);
        }
    }
    WorldRay<F> out{local, round ? F(1.0f) : -local.direction.z};
    CameraRay<F>& ray = out.ray;
    ray.origin = transform_point(world_from_camera, local.origin);
    ray.direction = transform_vector(world_from_camera, local.direction);
    if (camera.near_m > 0.0f) {
        const F skipped = F(camera.near_m) / max(out.axial, F(1e-6f));
        ray.origin = ray.origin + ray.direction * skipped;
        ray.cone_width = ray.cone_width + ray.cone_spread * skipped;
    }
    return out;
}

/// Maximum length of a ray from its origin: 0 outside the camera's image.
template <typename F>
OBSCURA_INLINE F length_of(const Camera& camera, const WorldRay<F>& made) {
    const F longest = F(1e38f);
    const F depth =
        camera.far_m > 0.0f ? F(camera.far_m - camera.near_m) / max(made.axial, F(1e-6f)) : longest;
    return select(made.ray.valid, depth, F(0.0f));
}

/// A single ray, for tests and cold code: through point.lens, or the centre of the lens.
template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const Camera& camera,
                                         const FilmPoint<F>& point,
                                         bool whole_lens = true) {
    CameraRay<F> ray;
    visit_model(camera, whole_lens, [&](auto maker) {
        ray = world_ray<decltype(maker)>(camera, point).ray;
    });
    return ray;
}

template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const Camera& camera, const Vec2<F>& film) {
    return generate_ray(camera, FilmPoint<F>{film, film, {F(0.5f), F(0.5f)}}, false);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
