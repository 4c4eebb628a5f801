// gltf/geometry/splat_primitive.h - reads one primitive of Gaussian splats into plain arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_primitive.h"
#include "surface/harmonics.h"

#include <array>
#include <optional>
#include <vector>

namespace obscura::gltf {

/// Splats in their mesh's space.
struct SplatPrimitive {
    int degree = 0;                ///< of the harmonics
    std::vector<float> positions;  ///< 3 a splat
    std::vector<float> rotations;  ///< 4, a quaternion of any length
    std::vector<float> scales;     ///< 3, standard deviations
    std::vector<float> opacities;
    std::array<std::vector<float>, max_harmonics> harmonics;  ///< 3; by l^2 + n
    std::vector<uint32_t> good;                               ///< the splats that can be drawn
    std::optional<PrimitiveFault> fault;                      ///< what is wrong with the others
    bool scales_were_logarithms = false;
};

/// Reads a primitive of splats. Scales with a negative number among them are logarithms, which
/// drafts of the extension asked for.
///
/// Errors  65 E-MESH-SPLATS attributes are missing; E-MESH-ATTRIBUTE, E-MESH-COUNT, E-MESH-EMPTY,
///         E-MESH-INDEX, E-ACC-*; 77 E-LIMIT-COUNT, E-LIMIT-VERTICES
Result<SplatPrimitive> read_splat_primitive(const Document& document,
                                            const BufferStore& store,
                                            PrimitiveName name);

}  // namespace obscura::gltf
