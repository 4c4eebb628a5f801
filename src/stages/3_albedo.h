// stages/3_albedo.h - stage 3 for the AOV `albedo`: of the first rough surface on each path.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_surface.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The albedo of the hits of one group.
struct HitAlbedo {
    Vec3<Lanes> color;
    Mask passed_on;  ///< by mirrors, clear glass, and boundaries inside a denser medium
};

/// The share of light that the surfaces send back or on, each channel in [0, 1], as seen along
/// their normals, so that it depends on neither the view nor light:
///   matte and plastic    base colour, and the 4 % or so that the dielectric reflects
///   metal                base colour
///   specular, ior        as the dielectric's reflectance at normal incidence has them
///   sheen, clearcoat     added, and what is below gets what they leave
///   transmission         rough glass: reflected and transmitted light, 1 where it is white
///   diffuse transmission its colour, where it takes the place of the diffuse base
///   volume               no absorption: that depends on the way inside; where it scatters, the
///                        colour of a deep medium
///   unlit                base colour
/// Emission is not part of it.
///
/// In      path: its medium stack; interaction: of these hits, by HitUse::attributes; common: of
///         the same
/// Source  Open Image Denoise, documentation, "Albedos"
HitAlbedo albedo_at(const SceneView& scene,
                    const HitLanes& hit,
                    const PathLanes& path,
                    const SurfaceInteraction& interaction,
                    const CommonTexel& common);

/// Writes the albedo that paths find behind mirrors and glass: throughput times the albedo of the
/// hit. A path that leaves the scene counts its throughput, as if the surroundings were white:
/// what is seen then is the mirror's or the glass' own colour.
///
/// In      bounce: at least 1; columns: before shading. Hits of the last bounce count as rough
/// In/Out  columns.passed_on: 0 once a path has its albedo
/// Out     columns.albedo: of those paths. Returns how many others were passed on again
/// Source  as albedo_at: "the Fresnel blend of the reflected and transmitted albedos", here by the
///         path's own choice between the two
int follow_albedo(const SceneView& scene,
                  const BatchSettings& batch,
                  int bounce,
                  int count,
                  const AlbedoColumns& columns);

}  // namespace OBSCURA_ISA
}  // namespace obscura
