// image/cube_environment.h - the six faces of a cube become a latitude-longitude environment.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/pixels.h"
#include "math/transform.h"

#include <array>
#include <string>

namespace obscura {

/// A picture of an image-based light as linear RGB. What a PNG's colours are divided by is its
/// alpha (RGBD), so that they reach 255; a PNG without alpha, or any other picture, has what it
/// shows. Colours are sRGB.
///
/// Source  EXT_lights_image_based, "HDR Images"
ImageRgb32f light_from_picture(const ImageRgba8& picture);

/// Faces in the order +X, -X, +Y, -Y, +Z, -Z, all square and alike in size. Each is what an eye in
/// the middle of a right-handed world sees; up is +Y, on the upper face -Z, on the lower one +Z.
using CubeFaces = std::array<ImageRgb32f, 6>;

/// The point of a face that is s to the right and t down of its middle, both in [-1, 1], is middle
/// + s * right + t * down, on a cube from -1 to 1.
struct CubeFaceFrame {
    Vec3d middle, right, down;
};

/// Source  EXT_lights_image_based, "Prefiltered Specular Radiance Cubemaps": the faces of
/// OpenGL 4.6,
///         table 8.19, each flipped about its vertical axis
CubeFaceFrame cube_face_frame(size_t face);

/// Resamples a cube to four columns for each texel of a face's side, 256 at least, and half as many
/// rows. Every pixel is the mean over its solid angle of the cube with bilinear interpolation,
/// which goes on across the cube's edges.
///
/// In      cube_from_world: a rotation, from directions in the world to those in the cube
/// Errors  65 E-ENV-FACES the faces are not square or differ in size; 77 E-ENV-LIMIT a side over
///         4096
Result<ImageRgb32f> environment_from_cube(const CubeFaces& faces,
                                          const Affined& cube_from_world,
                                          const std::string& where);

}  // namespace obscura
