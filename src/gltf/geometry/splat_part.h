// gltf/geometry/splat_part.h - one primitive of Gaussian splats as plain arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_part.h"
#include "surface/harmonics.h"

#include <array>
#include <optional>
#include <vector>

namespace obscura {

/// Splats in their mesh's space.
struct SplatPart {
    int degree = 0;                ///< of the harmonics
    std::vector<float> positions;  ///< 3 a splat
    std::vector<float> rotations;  ///< 4, a quaternion of any length
    std::vector<float> scales;     ///< 3, standard deviations
    std::vector<float> opacities;
    std::array<std::vector<float>, most_harmonics> harmonics;  ///< 3; by l^2 + n
    std::vector<uint32_t> good;                                ///< the splats that can be drawn
    std::optional<PartFault> fault;                            ///< what is wrong with the others
    bool scales_were_logarithms = false;
};

/// Reads a primitive of splats. Scales with a negative number among them are logarithms, which
/// drafts of the extension asked for.
///
/// Errors  65 E-MESH-SPLATS attributes are missing; E-MESH-ATTRIBUTE, E-MESH-COUNT, E-MESH-EMPTY,
///         E-MESH-INDEX, E-ACC-*; 77 E-LIMIT-COUNT, E-LIMIT-VERTICES
Result<SplatPart> read_splat_part(const Document& document,
                                  const BufferStore& store,
                                  PartName name);

}  // namespace obscura
