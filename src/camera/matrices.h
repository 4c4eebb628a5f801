// camera/matrices.h - the world-to-camera and world-to-NDC matrices for image metadata.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

namespace obscura {

/// OpenEXR's standard attributes: row-major 4x4 matrices for row vectors (p' = p * M).
struct CameraMatrices {
    float world_to_camera[16];
    /// x, y in [-1, 1] over the image (y up), after division by w.
    float world_to_ndc[16];
    bool has_ndc;  ///< false: this camera's projection is no matrix; world_to_ndc is zero
};

/// In      znear_m, zfar_m: only shape the z of NDC; > 0, zfar_m > znear_m
CameraMatrices camera_matrices(const Camera& camera, double znear_m, double zfar_m);

}  // namespace obscura
