// gltf/geometry/deform.h - bends a primitive: morph targets first, then its skin.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/part_reader.h"

#include <span>
#include <vector>

namespace obscura {

/// Adds weight * difference to values, both in runs of so many numbers a vertex; numbers of a value
/// that its difference lacks stay (a tangent's handedness).
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

/// Moves every vertex by the mean of its joints' matrices: positions by it, normals by its inverse
/// transpose, tangents along. Where most vertices are mirrored, the triangles turn round.
///
/// Source  glTF 2.0, section 3.7.3.3
void skin_part(const VertexJoints& from, std::span<const Affined> world_from_bind, MeshPart& part);

/// Reads what bends a primitive and bends it; positions may end up anywhere. Only targets whose
/// weight is not 0 are read.
///
/// Errors  65 E-SKIN-JOINT a vertex hangs on a joint that the skin has not; those of read_attribute
Result<void> deform_part(PartReader& reader, const PartPose& pose, MeshPart& part);

}  // namespace obscura
