// camera/camera.h - the closed list of camera models, as one plain record that a stage can read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/orthographic.h"
#include "camera/pinhole.h"

namespace obscura {

/// To add a model: write camera/<model>.h with its parameters, `generate_ray` and the source of the
/// formula, append a name here and a member to Camera, add a case to generate_ray below and to
/// ndc_from_camera in camera/matrices.cpp, and a test against the closed form in tests/camera.
enum class CameraModel : int { pinhole = 0, orthographic = 1 };

/// A camera in the world. Only the member that `model` names is used.
struct Camera {
    CameraModel model = CameraModel::pinhole;
    Affinef world_from_camera;  ///< rigid: rotation and translation; looks down -Z, +Y up
    PinholeCamera pinhole;
    OrthographicCamera orthographic;
};

inline namespace OBSCURA_ISA {

/// Makes the world-space ray for one film point.
///
/// In      film: [0,1]^2 over the picture, (0,0) is the top left corner
/// Out     unit direction; footprint of one pixel for texture filtering
template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const Camera& camera, const Vec2<F>& film) {
    const CameraRay<F> local = camera.model == CameraModel::orthographic
                                   ? generate_ray(camera.orthographic, film)
                                   : generate_ray(camera.pinhole, film);
    Affine<F> world_from_camera;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            world_from_camera.m[r][c] = F(camera.world_from_camera.m[r][c]);
        }
    }
    CameraRay<F> ray = local;
    ray.origin = transform_point(world_from_camera, local.origin);
    ray.direction = transform_vector(world_from_camera, local.direction);
    return ray;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
