// explain/camera_working.h - works out step by step how a camera turns a pixel into a ray.
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
    bool sees = true;              ///< false: the model shows nothing at this pixel
    crosscheck::TrueRay ray = {};  ///< in the world, its direction of length 1
    double length_m = INFINITY;    ///< longest distance from its origin
};

/// Works out the ray through the centres of a pixel and of the lens, in double precision and from
/// the definitions in docs/cameras.md; only the camera's numbers are shared with src/camera.
CameraWorking work_out_camera(const Camera& camera, const PixelPlace& pixel);

}  // namespace obscura
