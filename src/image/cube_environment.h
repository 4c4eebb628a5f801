// image/cube_environment.h - converts a cube map to a latitude-longitude environment.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/pixels.h"
#include "math/transform.h"

#include <array>
#include <string>

namespace obscura {

/// An image of an image-based light as linear RGB. The colours of a PNG are divided by its alpha
/// (RGBD), so that they reach 255; a PNG without alpha and other formats are used as stored.
/// Colours are sRGB.
///
/// Source  EXT_lights_image_based, "HDR Images"
ImageRgb32f light_from_image(const ImageRgba8& image);

/// Faces in the order +X, -X, +Y, -Y, +Z, -Z, all square and of one size. Each is the view from the
/// centre of a right-handed world; up is +Y, on the upper face -Z, on the lower one +Z.
using CubeFaces = std::array<ImageRgb32f, 6>;

/// Maps the point of a face that is s to the right and t down from its centre, both in [-1, 1], to
/// middle + s * right + t * down, on a cube from -1 to 1.
struct CubeFaceFrame {
    Vec3d middle, right, down;
};

/// Source  EXT_lights_image_based, "Prefiltered Specular Radiance Cubemaps": the faces of OpenGL
///         4.6, table 8.19, each flipped about its vertical axis
CubeFaceFrame cube_face_frame(size_t face);

/// Resamples a cube to four columns for each texel of a face's side, at least 256, and half as many
/// rows. Every pixel is the mean of the cube over its solid angle, with bilinear interpolation that
/// continues across the cube's edges.
///
/// In      cube_from_world: a rotation, from directions in the world to those in the cube
/// Errors  65 E-ENV-FACES the faces are not square or differ in size; 77 E-ENV-LIMIT a side over
///         4096
Result<ImageRgb32f> environment_from_cube(const CubeFaces& faces,
                                          const Affined& cube_from_world,
                                          const std::string& where);

}  // namespace obscura
