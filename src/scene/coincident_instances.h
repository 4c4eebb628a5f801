// scene/coincident_instances.h - finds what was placed again and again on one spot.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <vector>

namespace obscura {

/// A few copies may be meant (alpha adds up) and cost little. Every ray that meets one meets all.
inline constexpr uint32_t most_copies = 16;

/// Removes all but the first of the instances of one mesh that are in the same place, bit by bit
/// and at every time, where there are more than most_copies of them. Returns those removed.
std::vector<Instance> leave_out_copies(Scene& scene);

}  // namespace obscura
