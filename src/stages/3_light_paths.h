// stages/3_light_paths.h - what shading tells the light layers: scatterings and arriving light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_surface.h"
#include "stages/stages.h"
#include "surface/lobe_shares.h"

namespace obscura {
inline namespace OBSCURA_ISA {

// Not inlined into shading, which calls them only where light layers are asked for. Radiance holds
// the path's throughput.

/// Light that a surface emits towards its path.
void add_emitted_light(const LightPathColumns& columns,
                       Mask lanes,
                       const HitLanes& hit,
                       LanesU slot,
                       const Vec3<Lanes>& radiance);

/// Light of the environment or the background, at paths that left the scene.
void add_background_light(const LightPathColumns& columns,
                          Mask lanes,
                          LanesU slot,
                          const Vec3<Lanes>& radiance);

/// Light of unoccluded shadow rays, of which no sample has two.
void add_shadow_layers(const LightPathColumns& columns,
                       int count,
                       const ShadowView& shadows,
                       const uint8_t* occluded);

/// A scattering at shaded points.
struct Scattering {
    const ShadingPoint& s;
    ScatteredLight<Lanes> light;
};

/// Weights of the shadow rays of a group, and the light classes that they belong to. Must come
/// before scatter_path of the same group. Where all lobes settle a path, its shadow ray has no
/// weights of its own, and columns.progress says so; with columns.goes_straight the caller gives
/// it some before it is traced, if the path passes the surface (LightPathState).
///
/// In   light: index by light sampling
void scatter_shadow(const LightPathColumns& columns,
                    Mask lanes,
                    LanesU slot,
                    LanesI light,
                    const Scattering& scattering);

/// The light classes of the shadow rays of a group.
///
/// In   light: index by light sampling
void note_shadow_class(const LightPathColumns& columns, Mask lanes, LanesU slot, LanesI light);

/// Moves the weights of paths that go on into a new direction.
void scatter_path(const LightPathColumns& columns,
                  Mask lanes,
                  LanesU slot,
                  const Scattering& scattering);

}  // namespace OBSCURA_ISA
}  // namespace obscura
