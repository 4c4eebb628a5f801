// gltf/geometry/farthest_position.h - how far from the origin geometry may lie.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura::gltf {

/// Largest coordinate, metres: Embree drops triangles beyond 1.8e18.
inline constexpr double farthest_position = 1e18;

}  // namespace obscura::gltf
