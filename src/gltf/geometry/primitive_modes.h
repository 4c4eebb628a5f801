// gltf/geometry/primitive_modes.h - turns vertices in order into points, lines, triangles.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace obscura::gltf {

inline constexpr int points_mode = 0, lines_mode = 1, line_loop_mode = 2, line_strip_mode = 3,
                     triangles_mode = 4, triangle_strip_mode = 5;

/// In the place of a mode: LoadOptions::hidden leaves the primitive out.
inline constexpr int hidden_mode = -1;

inline constexpr bool is_point_or_line_mode(int mode) {
    return mode >= points_mode && mode < triangles_mode;
}

/// Vertices of one triangle, line segment or point.
inline constexpr size_t element_corners(int mode) {
    if (mode == points_mode) return 1;
    return is_point_or_line_mode(mode) ? 2 : 3;
}

/// Triangles that a primitive makes from so many vertices; 0 for points and lines.
uint64_t triangle_count(int mode, uint64_t vertex_count);

/// The vertices of a primitive as a list: one a point, two a line segment, three a triangle.
/// Segments and, in strips and fans, triangles that repeat a vertex are left out: they have no
/// extent.
struct ElementList {
    std::vector<uint32_t> vertices;
    bool leftover = false;  ///< the last vertices make no element
};
ElementList element_list(std::vector<uint32_t> order, int mode);

}  // namespace obscura::gltf
