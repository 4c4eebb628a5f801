// stages/3_rough_paths.h - smooth lobes where paths meet them that have scattered roughly before.
// SPDX-License-Identifier: Apache-2.0
//
// Light that comes to a rough surface by way of a smooth one is a caustic. A path from the eye
// finds it by chance, the rarer and brighter the smaller the light and the smoother the surface.
// Two options give up some truth for less noise: --caustics off and --regularize.
#pragma once

#include "stages/3_layers.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Lobes of this GGX width and wider, and all that have none, are rough; the others are smooth.
inline constexpr float min_rough_width = 0.3f;

/// True where a sampled lobe is rough.
///
/// In      spread: as BsdfSample has it, half the GGX width
OBSCURA_INLINE Mask is_rough(Lanes spread) {
    return spread >= Lanes(0.5f * min_rough_width);
}

/// Hits whose lobes may change.
struct RoughPathHit {
    Mask rough;      ///< lanes whose paths have scattered roughly
    Vec3<Lanes> wo;  ///< in the shading frame
    BsdfParams<Lanes> bsdf;
    LobeWeights<Lanes> lobes;
};

/// Widens smooth lobes. Smooth thin walls stay as they are, for shadow rays pass them straight.
///
/// In/Out  layers: null if no lane has layers; nothing was taken out of its lobes
/// Source  Kaplanyan and Dachsbacher, "Path Space Regularization for Holistic and Robust Light
///         Transport", Eurographics 2013; widths as in Pharr, Jakob, Humphreys, "Physically Based
///         Rendering", 4th ed., 2023, section 14.3.3
void regularize(RoughPathHit& hit, LayeredPoint* layers);

/// Removes smooth lobes. What goes straight through thin walls is no caustic and stays.
///
/// In/Out  layers: null if no lane has layers; after pass_thin_walls. The probabilities of its
///         lobes keep their sum
void remove_smooth_lobes(RoughPathHit& hit, LayeredPoint* layers);

}  // namespace OBSCURA_ISA
}  // namespace obscura
