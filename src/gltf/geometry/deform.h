// gltf/geometry/deform.h - deforms a primitive: morph targets first, then its skin.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/primitive_reader.h"

#include <span>
#include <vector>

namespace obscura::gltf {

/// Adds weight * difference to values. Components that a difference lacks (a tangent's handedness)
/// are kept.
struct MorphSum {
    std::vector<double> sums;
    size_t value_width = 3;

    void add(double weight, std::span<const float> differences, size_t difference_width);
};

/// Which joints move each vertex, and how much.
struct VertexJoints {
    size_t influences = 0;         ///< a vertex
    std::vector<uint32_t> joints;  ///< each below the number of joints where its weight is not 0
    std::vector<float> weights;    ///< 0 or more; those of a vertex sum to 1
};

/// Moves every vertex by the mean of its joints' matrices: positions and tangents by the mean,
/// normals by its inverse transpose. Where most vertices are mirrored, the winding is reversed.
///
/// Source  glTF 2.0, section 3.7.3.3
void skin_primitive(const VertexJoints& from,
                    std::span<const Affined> world_from_bind,
                    MeshPrimitive& primitive);

/// Reads a primitive's morph targets and skin and deforms it; the caller checks whether positions
/// are still in range. Only targets whose weight is not 0 are read.
///
/// Errors  65 E-SKIN-JOINT a vertex names a joint that the skin lacks; those of read_attribute
Result<void> deform_primitive(PrimitiveReader& reader,
                              const PrimitivePose& pose,
                              MeshPrimitive& primitive);

}  // namespace obscura::gltf
