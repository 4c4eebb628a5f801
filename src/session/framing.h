// session/framing.h - views that show a whole asset, and placing a camera by eye and target.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "scene/scene.h"
#include "session/framed_geometry.h"
#include "session/view_sampling.h"

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
    double tan_half_yfov = 1;  ///< of a pinhole; as asked for, unless the view is zoomed
};

/// What decides the size of a framed view: tight, what is seen reaches to the margins; sphere, a
/// ball around the middle does, so that views from all sides have the same scale.
enum class FrameFit { tight, sphere };

/// How a view is framed.
struct FramingOptions {
    FrameFit fit = FrameFit::tight;
    double margin = 0.05;                    ///< of the image's width and height, on each side
    double azimuth_rad = 30 * pi_d / 180;    ///< of the eye, from +Z towards +X
    double elevation_rad = 20 * pi_d / 180;  ///< of the eye, above the horizon
    double roll_rad = 0;                     ///< turns the image clockwise
    double zoom = 1;                         ///< enlarges the image about its middle
};

/// The lens of a framed view.
struct FrameLens {
    double yfov_rad = default_yfov_rad;  ///< in (0, pi)
    double aspect = 1;                   ///< width / height
    bool orthographic = false;
};

/// Looks at the geometry from the front (glTF assets face +Z), a little from the right and above,
/// or as the options say. What is seen lies in the middle, and reaches to the margins in one
/// direction; the margins on opposite sides are equal.
///
/// In      geometry: where it is empty it counts as a box of 2 m at the origin, a point as one of
///         2 m around it
Framing frame_view(const FramedGeometry& geometry,
                   const FramingOptions& options,
                   const FrameLens& lens);

/// A view from inside the bounds; its target is their half diagonal ahead.
Framing view_inside(const Bounds& bounds, const InsidePlace& place, const FrameLens& lens);

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
