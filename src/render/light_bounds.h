// render/light_bounds.h - what the light tree knows of each light, and which scenes have a tree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_tree.h"
#include "render/light_table.h"

#include <span>
#include <vector>

namespace obscura {

/// With fewer lights, choosing by the point that is lit costs more than it gains.
inline constexpr size_t min_tree_lights = 16;

/// Where shadow rays leave media, so few punctual lights are chosen by the table: what of their
/// light a medium scatters is sampled along the whole segment (stages/2_scatter_lights.h), which
/// needs the light before the place, and the tree needs the place before the light.
inline constexpr int max_points_apart = 8;

/// The lights that are chosen by a tree: all with a place, that is without directional ones and the
/// environment. None where they are fewer than min_tree_lights: there the table alone chooses.
///
/// In      table: with all its lights; power: of punctual lights, triangles and shapes, by number;
///         scene: tells Motion's steps, and whether there are such media
std::vector<BoundedLight> bounded_lights(const LightTable& table,
                                         std::span<const double> power,
                                         const Scene& scene);

}  // namespace obscura
