// scene/coincident_instances.h - removes instances that lie on top of each other many times.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <vector>

namespace obscura {

/// Up to this many copies are kept: a few may be intended (alpha adds up) and cost little. Every
/// ray that hits one hits all.
inline constexpr uint32_t max_copies = 16;

/// Where more than max_copies instances of one mesh have equal transforms, bit by bit and at every
/// time, removes all but the first. Returns the removed ones.
std::vector<Instance> leave_out_copies(Scene& scene);

}  // namespace obscura
