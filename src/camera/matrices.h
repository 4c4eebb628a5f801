// camera/matrices.h - the camera as an image's header describes it: matrices and screen window.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <array>
#include <optional>

namespace obscura {

/// A 4x4 matrix for row vectors (p' = p * M), row after row.
using RowMatrix4 = std::array<float, 16>;

/// What a flat image shows of the plane one unit ahead of the eye.
struct ScreenWindow {
    float width;
    /// Of the window's middle. +x is to the LEFT here, unlike in world_to_camera, and +y is up:
    /// OpenEXR defines it so.
    float center_x;
    float center_y;
};

/// The camera by OpenEXR's definitions of its standard attributes.
///
/// Source  OpenEXR, "Standard Attributes" (worldToCamera, worldToNDC) and "Technical Introduction"
///         (screen window)
struct CameraMatrices {
    /// To a left-handed space in metres: +x is right, +y up, +z ahead.
    RowMatrix4 world_to_camera;
    /// After division by w, (0, 0) is the upper left corner of the whole image, (1, 1) the lower
    /// right one; z is 0 at znear_m and 1 at zfar_m. None: the projection is no matrix.
    std::optional<RowMatrix4> world_to_ndc;
    /// None: the image is no perspective one, or it is distorted.
    std::optional<ScreenWindow> screen_window;
};

/// In      znear_m, zfar_m: only shape the z of NDC; > 0, zfar_m > znear_m
CameraMatrices camera_matrices(const Camera& camera, double znear_m, double zfar_m);

}  // namespace obscura
