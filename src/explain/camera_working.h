// explain/camera_working.h - how a camera's formula turns a pixel into a ray, step by step.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"
#include "crosscheck/box_tree.h"

#include "explain/term.h"

namespace obscura {

struct PixelPlace {
    int x = 0, y = 0;  ///< from the top left corner
    int width = 0, height = 0;
};

struct CameraWorking {
    std::string model;  ///< as --camera-model writes it, and the kind of fisheye or projection
    std::vector<Term> terms;
    bool sees = true;            ///< false: the model shows nothing at this pixel
    TrueRay ray = {};            ///< in the world, its direction of length 1
    double length_m = INFINITY;  ///< how far it may go, from its origin
};

/// Works out the ray through a pixel's middle and the middle of the lens, in double precision and
/// from the definitions in docs/cameras.md: nothing but the camera's numbers is shared with
/// src/camera.
CameraWorking work_out_camera(const Camera& camera, const PixelPlace& pixel);

}  // namespace obscura
