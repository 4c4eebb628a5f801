// session/framing.h - views that show a whole asset, and placing a camera by eye and target.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "scene/scene.h"

namespace obscura {

/// Vertical angle of the automatic framing and of cameras placed by hand without --fov.
inline constexpr double default_yfov_rad = 35.0 * 3.14159265358979323846 / 180.0;

/// Where a camera stands and looks; `forward` and `up` need not be unit or at right angles.
struct Viewpoint {
    Vec3d eye_m = {0, 0, 0};
    Vec3d target_m = {0, 0, -1};
    Vec3d up = {0, 1, 0};
};

/// An automatic view: the viewpoint, and half the image's height in the target's plane.
struct Framing {
    Viewpoint view;
    double half_height_m = 1;
};

/// Looks at the bounds from the front (glTF assets face +Z), a little from the right and above,
/// such that all eight corners lie within 95 % of the frame and touch it in one direction.
/// Empty bounds count as a box of 2 m at the origin, a point as one of 2 m around it.
Framing frame_perspective(const Bounds& bounds, double yfov_rad, double aspect);
Framing frame_orthographic(const Bounds& bounds, double aspect);

/// Rigid world_from_camera, looking from eye to target along -Z with `up` in the +Y half.
///
/// Errors  64 E-CAM-VIEW eye equals target, or up is zero or parallel to the view
Result<Affined> look_at(const Viewpoint& view);

/// The rotation and translation of a node's matrix, its scale and mirroring left out: the view
/// direction is kept, then the up direction.
///
/// Errors  65 E-CAM-SINGULAR the matrix flattens the camera
Result<Affined> rigid_part(const Affined& world_from_node, const std::string& where);

/// Centre and half diagonal of the bounds; of the stand-in box where they are empty or a point.
struct BoundingSphere {
    Vec3d centre_m;
    double radius_m;
};
BoundingSphere bounding_sphere(const Bounds& bounds);

}  // namespace obscura
