// gltf/geometry/tangents.h - tangents for meshes that come without them, after MikkTSpace.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace obscura::gltf {

/// A triangle list. Every index is below the number of vertices; all vertex arrays agree in length.
struct TangentMesh {
    std::span<const float> positions;   ///< 3 floats a vertex
    std::span<const float> normals;     ///< 3 floats a vertex, unit
    std::span<const float> uvs;         ///< 2 floats a vertex, those of the normal texture
    std::span<const uint32_t> indices;  ///< 3 a triangle
};

/// Makes the tangent of every triangle corner.
///
/// Out     4 floats a corner: a unit vector orthogonal to the corner's normal, and w = 1 or -1 such
///         that the bitangent is cross(normal, tangent) * w and points towards decreasing v, which
///         is up in the image (glTF counts v downwards, MikkTSpace upwards). Corners of equal
///         position, normal and UV may still differ, where a mirrored texture meets itself.
/// Errors  none: corners without a direction in the UVs get the X axis, else Y, laid into the
///         normal's plane, and w = -1
/// Source  Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, and the MikkTSpace
///         rules at http://www.mikktspace.com; glTF 2.0 section 3.7.2.1 asks for them
std::vector<float> make_tangents(const TangentMesh& mesh);

}  // namespace obscura::gltf
