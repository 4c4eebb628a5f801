// gltf/animation.h - keyframes of animations, read and interpolated.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/accessors.h"

#include <array>
#include <span>
#include <vector>

namespace obscura::gltf {

/// How values between two keyframes are interpolated.
struct KeyframeKind {
    Interpolation interpolation = Interpolation::linear;
    size_t width = 1;         ///< numbers in a value
    bool quaternion = false;  ///< values are unit quaternions (x, y, z, w)
};

/// A value over time. CUBICSPLINE has three values a key: tangent in, value, tangent out.
struct Keyframes {
    KeyframeKind kind;
    std::vector<float> times;  ///< seconds, never falling
    std::vector<float> values;
};

/// Interpolates in double; before the first and after the last key that key's value holds.
///
/// Out     kind.width numbers; a quaternion is unit
/// Source  glTF 2.0, appendix C: step, linear, spherical linear (the short way), cubic spline
std::vector<double> sample(const Keyframes& keys, double time_s);

/// Turns from a to b the short way, at a constant rate; both unit.
///
/// Source  Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985
std::array<double, 4> slerp(const std::array<double, 4>& a,
                            const std::array<double, 4>& b,
                            double fraction);

/// Reads a sampler's times and values.
///
/// Errors  65 E-ANIM-TIMES times fall or are not finite, E-ANIM-VALUE values are not finite, a
///         quaternion has no length; those of read_floats
Result<Keyframes> read_keyframes(const Document& document,
                                 const BufferStore& buffers,
                                 const GltfAnimationSampler& sampler,
                                 const KeyframeKind& kind);

/// Time of an animation's last key in seconds; 0 when it has none.
///
/// Errors  those of read_keyframes about times
Result<double> animation_end(const Document& document,
                             const BufferStore& buffers,
                             const GltfAnimation& animation);

}  // namespace obscura::gltf
