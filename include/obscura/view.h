// include/obscura/view.h - what is looked at, through which camera, and how light is computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/api.h"
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

OBSCURA_BEGIN_API

using Vector3 = std::array<double, 3>;

enum class CameraModel { pinhole, orthographic, thin_lens, fisheye, environment };

/// Part of an image in pixels, from its top left corner.
struct Rect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// A camera as OpenCV and COLMAP describe it: +X right, +Y down, it looks along +Z. The world is
/// glTF's. Matrices are row after row.
struct OpenCvCamera {
    std::array<double, 9> K = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< fx 0 cx, 0 fy cy, 0 0 1; pixels
    std::array<double, 9> R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Vector3 t = {0, 0, 0};      ///< metres: X_camera = R X_world + t
    int width = 0, height = 0;  ///< of the image that K is for; 0: the View's
    double pixel_center = 0.5;  ///< where K has the first pixel's centre: 0.5, or 0
};

/// A camera, an image size and a time. What is not set is as the file says; a file without camera
/// is framed as a whole.
///
/// Which camera: `world_from_camera`, `camera_json` or `opencv`, else any of `eye`, `target` and
/// `up`, else `camera`, else the file's first one, else a view of all. docs/cameras.md explains the
/// models and lenses.
struct View {
    int width = 1280;
    int height = 720;
    std::optional<Rect> crop;  ///< renders, and holds in memory, this part only

    std::string camera;  ///< one of the file: its name, else its index
    std::optional<Vector3> eye, target, up;
    /// A rigid placing, element 4 r + c of a matrix for column vectors; the camera looks along -Z.
    std::optional<std::array<double, 16>> world_from_camera;
    /// A file with a camera as computer vision writes it, scaled to `width` and `height`.
    std::string camera_json;
    /// The same without a file; its lens is `distortion`, or the fisheye "opencv".
    std::optional<OpenCvCamera> opencv;
    std::optional<CameraModel> camera_model;
    std::optional<double> fov_deg;  ///< vertical angle; of a fisheye the whole one

    std::optional<double> near_m, far_m;                   ///< clip what is nearer or further away
    std::optional<std::array<double, 2>> magnification_m;  ///< half width and height; orthographic
    std::optional<double> focal_length_m;
    std::optional<std::array<double, 2>> sensor_m;    ///< width and height
    std::optional<std::array<double, 2>> shift;       ///< in images: right, up
    std::optional<std::array<double, 5>> distortion;  ///< k1 k2 p1 p2 k3, as OpenCV defines them

    std::optional<double> fstop, lens_radius_m;  ///< give a thin lens its opening
    std::optional<double> focus_distance_m;
    std::optional<std::array<int, 2>> focus_on_px;  ///< focuses on what this pixel shows
    std::optional<int> blades;
    std::optional<double> blade_rotation_deg, anamorphic;
    std::string aperture;  ///< a file: light passes where the image is bright

    std::string fisheye;  ///< "equidistant", "equisolid", "stereographic", "orthographic", "opencv"
    std::string fisheye_fit;                                    ///< "circle", "diagonal"
    std::optional<std::array<double, 4>> fisheye_coefficients;  ///< k1 to k4 of "opencv"

    std::string projection;          ///< of all directions: "latlong", "cylindrical", "cubemap"
    std::string align;               ///< centre of such an image: "world" (+X), "view" (ahead)
    std::optional<double> stereo_m;  ///< between two eyes, the left one's image above the other's

    /// Exposure of images that are written for a display: EV at ISO 100, or time and speed with
    /// `fstop`.
    std::optional<double> ev100, exposure_s, iso;

    /// Seconds of the animation; none: the asset as it is stored.
    std::optional<double> time_s;
    /// Blurs what moves: when the shutter opens and closes, in seconds from `time_s`.
    std::optional<std::array<double, 2>> shutter_s;
};

enum class Background { environment, transparent, color };

/// The light around the asset, and the size of points and lines.
struct Look {
    std::string environment;  ///< .exr .hdr .png .jpg, "studio", "sky:30,40"; empty: the asset's
    double environment_intensity = 1;
    double environment_rotation_deg = 0;  ///< about +Y, counter-clockwise seen from above
    Background background = Background::environment;
    std::array<float, 3> background_color = {0, 0, 0};  ///< linear Rec.709
    double point_size_px = 3, line_width_px = 2;        ///< of POINTS and LINES
};

enum class Integrator {
    path,     ///< light transport
    direct,   ///< without light between surfaces
    raycast,  ///< hard shadows, no noise
    ao,       ///< ambient occlusion
    normal,   ///< N.X N.Y N.Z; from here on one ray through each pixel's centre
    facing,
    depth,  ///< Z: along the view axis
    distance,
    uv,  ///< UV.U UV.V
    albedo,
    id,  ///< id.node id.material id.triangle
    wireframe,
    heat  ///< traversal steps
};

enum class PixelFilter { box, gaussian, blackman_harris };

/// What is computed and how well.
struct Sampling {
    Integrator integrator = Integrator::path;
    int samples_per_pixel = 64;  ///< with `noise_target` the most
    /// Adaptive sampling, for path, direct and ao: pixels are sampled, more where they are noisy,
    /// until the relative error of the image is about this. docs/sampling.md explains it.
    std::optional<double> noise_target;
    /// Samples that every pixel takes at least, with `noise_target`; none: 16, or
    /// samples_per_pixel where that is less.
    std::optional<int> spp_min;
    int max_bounces = 8;
    std::uint64_t seed = 0;
    PixelFilter filter = PixelFilter::box;
    std::optional<double> ao_distance_m;  ///< none: a fifth of the asset's diagonal
    double wire_width_px = 1;
    /// Against fireflies, each at the price of a bias: see docs/fireflies.md. The most that any
    /// channel of one contribution may have, in the scene's radiance, where light comes straight to
    /// the first surface and where it comes by way of others; 0: anything.
    double clamp_direct = 0;
    double clamp_indirect = 0;
    bool caustics = true;     ///< false: no light by way of mirrors and glass to rough surfaces
    bool regularize = false;  ///< smooth surfaces are rougher to light that goes on to rough ones
    /// Layers beside the beauty, by the names of docs/layers.md: "depth", "crypto_object". They go
    /// with path, direct, raycast and ao.
    std::vector<std::string> aov;
    int crypto_levels = 6;  ///< ids of a pixel that Cryptomatte layers keep, from 1 to 64
};

OBSCURA_END_API
