// stages/3_catcher.h - stage 3 at shadow catchers: white Lambert surfaces that only receive light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// GGX roughness of the gloss that --catcher-reflections gives to catchers; its F0 is 4 %.
inline constexpr float catcher_roughness = 0.2f;

/// Light sampling at shadow catchers, and the next rays. What light sampling can find, it finds
/// alone: next rays bring only light that comes by way of other surfaces. So a catcher that nothing
/// shadows gets the same light with and without its shadow rays, in every sample.
///
/// In      columns.paths, columns.hits: `count` paths from the camera
/// Out     columns.shadows: with the light of an unoccluded white Lambert surface; columns.next;
///         columns.reflections: rays off a dielectric above it
/// Units   radiance; distance m
/// Errors  none
CatcherCounts shade_catchers(const SceneView& scene, int count, const CatcherColumns& columns);

}  // namespace OBSCURA_ISA
}  // namespace obscura
