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

/// The lights that are chosen by a tree: all with a place, that is without directional ones and the
/// environment. None where they are fewer than min_tree_lights: there the table alone chooses.
///
/// In      table: with all its lights; power: of punctual lights, triangles and shapes, by number;
///         steps: of Motion
std::vector<BoundedLight> bounded_lights(const LightTable& table,
                                         std::span<const double> power,
                                         int32_t steps);

}  // namespace obscura
